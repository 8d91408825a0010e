// Evidence of an effect in the motion that the command makes. An effect that hardly moves the model
// may still shape how it answers a disturbance, whose spectrum is not quite the noise model's.
#pragma once

#include <string>

#include "estimator/greybox/selection/innovation_stage.h"

namespace estimator::greybox::selection {

/// Nats by which readings without noise, the model's free run from each segment's start, would tell
/// the stage from itself without `effect`, by the noise model of the stage, its other parameters
/// held. `plain`: data without innovations.
[[nodiscard]] double driven_nats(const SearchContext& plain, const InnovationStage& stage,
                                 const std::string& effect);

/// True where these are no small share of what the effect gains.
[[nodiscard]] bool is_driven(const SearchContext& plain, const InnovationStage& stage,
                             const std::string& effect, double gain_nats);

}  // namespace estimator::greybox::selection
