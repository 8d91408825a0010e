// Gain on held-out data from which on a candidate is taken.
#pragma once

#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// The applicable one of the limits at a held-out error.
[[nodiscard]] double worthwhile_at(const SearchContext& context, double validation_rms_m);

/// True where a candidate's gain over the stage is worthwhile and not chance. Where noise explains
/// the stage, held-out data decide alone: a fit follows noise; or the candidate brings
/// parameters of the plant back that end at their bounds without it.
[[nodiscard]] bool is_gain(const SearchContext& context, const ModelStage& stage,
                           const Candidate& candidate);

}  // namespace estimator::greybox::selection
