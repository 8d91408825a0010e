// Effects that further effects have made idle, replaced by simpler ones.
#pragma once

#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// An effect taken before the others came in may keep nothing but a refinement, its size zero or
/// within its error. Every effect then competes for its place once more, with the others in the
/// model, and the simplest of those that explain the record alike takes it; the round is added to
/// the branch's.
void substitute_idle_effects(const SearchContext& context, SearchBranch& branch);

}  // namespace estimator::greybox::selection
