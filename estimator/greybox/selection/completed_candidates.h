// Completed fits of a round's candidates, which end early: of the one that is taken, and of its
// rivals where it explains the record, but not to the noise.
#pragma once

#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// The stage with a candidate, fitted to convergence, its refinements revived or replaced by
/// others.
[[nodiscard]] ModelStage completed(const SearchContext& context, const ModelStage& stage,
                                   const Candidate& candidate);

/// Completes the fits of the next best effects of a branch's only round where its effect leaves
/// more than noise does; the best takes its place where held-out data show that it leaves less.
void complete_rivals(const SearchContext& context, SearchBranch& branch);

}  // namespace estimator::greybox::selection
