// Path from the model as given to the final one, one effect at a time: at each step the one with
// the largest gain.
#pragma once

#include <vector>

#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// Stages from `first` (no additions) to `final`, both included; `added` is in path order in all of
/// them. An effect that leaves no less until another makes up for it comes in with that one.
[[nodiscard]] std::vector<ModelStage> path_to(const SearchContext& context, const ModelStage& first,
                                              const ModelStage& final);

/// The path restricted to effects that hold in CrossValidation, each on top of those kept before.
[[nodiscard]] std::vector<ModelStage> cross_validated_path(const SearchContext& context,
                                                           CrossValidation& halves,
                                                           const std::vector<ModelStage>& path);

}  // namespace estimator::greybox::selection
