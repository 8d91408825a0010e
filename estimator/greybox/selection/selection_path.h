// The way from the model as given to the final one, one effect at a time: at each step the one that
// brings most on top of those before it.
#pragma once

#include <vector>

#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// Stages from `first` (nothing added) to `final`, both included; `added` is in the order of the
/// way in all of them.
[[nodiscard]] std::vector<Stage> way_to(const Workshop& shop, const Stage& first,
                                        const Stage& final);

/// The way with those effects only that support.h supports, each on top of those kept before it.
[[nodiscard]] std::vector<Stage> supported_way(const Workshop& shop, const std::vector<Stage>& way);

}  // namespace estimator::greybox::selection
