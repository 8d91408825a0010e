// Pairs of absent effects fitted together, for records on which either alone misleads: leakage and
// friction together resemble a dead band.
//
// Every pair is simulated in several sizes of both; the projection (projection.h) gives the error
// that remains after the parameters adjust, and the sizes between those that were simulated. The
// most promising pairs are fitted to a segment, the best of these to the record. Periodic effects
// are excluded: their wavelengths would need a scan per partner.
#pragma once

#include <vector>

#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// For a stage with its Jacobian; best first by held-out error. `without`: effects already combined
/// with every other one.
[[nodiscard]] std::vector<Candidate> pair_search(const SearchContext& context,
                                                 const ModelStage& stage,
                                                 const std::vector<std::string>& without);

}  // namespace estimator::greybox::selection
