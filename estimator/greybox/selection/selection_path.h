// The way from the model as given to the final one, one effect at a time: at each step the one that
// brings most on top of those before it.
#pragma once

#include <vector>

#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// Stages from `first` (nothing added) to `final`, both included; `added` is in the order of the
/// way in all of them.
[[nodiscard]] std::vector<ModelStage> path_to(const SearchContext& context, const ModelStage& first,
                                              const ModelStage& final);

/// The way with those effects only that support.h supports, each on top of those kept before it.
[[nodiscard]] std::vector<ModelStage> cross_validated_path(const SearchContext& context,
                                                           const std::vector<ModelStage>& path);

}  // namespace estimator::greybox::selection
