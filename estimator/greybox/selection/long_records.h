// Long records: the search uses representative segments, the result is fitted to all samples.
#pragma once

#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// The same problem on representative segments where the records are long
/// (representative_segments.h).
[[nodiscard]] SearchContext for_search(const SearchContext& context);
/// True when `search` has segments only.
[[nodiscard]] bool uses_segments(const SearchContext& search, const SearchContext& context);

/// Fits and scores the selection path and the final model on all samples. Rounds keep the errors of
/// the search and their candidates' residuals.
void refit_to_whole(const SearchContext& context, StructureSearch& search);

}  // namespace estimator::greybox::selection
