// Two absent effects tried together from nothing: for records on which either of them alone leads
// astray, as leakage and friction do, which together look like a dead band.
//
// Every two are simulated in several sizes of both; what the parameters may then still take away is
// known by the projection (projection.h). The most promising are fitted. Periodic effects do not
// take part: their wavelengths would have to be scanned for each partner.
#pragma once

#include <vector>

#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// On top of a stage that has its Jacobian, best first by held-out error. `without`: effects that
/// have been tried with every other one already.
[[nodiscard]] std::vector<Candidate> pair_search(const SearchContext& context,
                                                 const ModelStage& stage,
                                                 const std::vector<std::string>& without);

}  // namespace estimator::greybox::selection
