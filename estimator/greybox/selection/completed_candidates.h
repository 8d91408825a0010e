// Completed fits of a round's candidates, which end early: of the one that is taken, and of its
// rivals where it explains the record, but not to the noise.
#pragma once

#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// The stage with a candidate, fitted to convergence, its refinements revived or replaced by
/// others.
[[nodiscard]] ModelStage completed(const SearchContext& context, const ModelStage& stage,
                                   const Candidate& candidate);

/// Where the effect of a branch's only round leaves more than noise does: tries its other
/// refinements, and completes the fits of the next best effects; what leaves less by held-out data
/// takes its place.
void complete_rivals(const SearchContext& context, SearchBranch& branch);

}  // namespace estimator::greybox::selection
