// Slow drifts of null and load as beginnings of a search for changes.
//
// Where a drift moves the rig far, the parameters that are fitted without it are bent so far that
// neither a score nor the innovations find back to it. Simulations with the drift do, from the
// file's values on.
#pragma once

#include <vector>

#include "estimator/greybox/selection/change_proposals.h"

namespace estimator::greybox::selection {

/// Drifts fitted by simulations, those that leave less than `most_m` on held-out data, best first;
/// none for several records. `first`: the model as given, its parameters fitted.
[[nodiscard]] std::vector<ChangeProposal> drift_starts(const SearchContext& context,
                                                       const ModelStage& first, double most_m);

}  // namespace estimator::greybox::selection
