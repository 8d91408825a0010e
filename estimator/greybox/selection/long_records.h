// Long records: the search goes over stretches of them, and what it found is fitted to the whole.
#pragma once

#include <string>

#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// The same workshop, with stretches for evidence when the records are long
/// (representative_segments.h).
[[nodiscard]] SearchContext for_search(const SearchContext& context);
/// Whether `search` has stretches only.
[[nodiscard]] bool uses_segments(const SearchContext& search, const SearchContext& context);

/// The ladder's way and final model fitted to all of the evidence and scored there. Rounds keep the
/// errors that they had in the search, and their candidates' residuals.
void refit_to_whole(const SearchContext& context, StructureSearch& search);

/// "effects were searched for in 60 of 600 s; ..."
[[nodiscard]] std::string note_of_search(const SearchContext& search, const SearchContext& context);

}  // namespace estimator::greybox::selection
