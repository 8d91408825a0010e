// Refinements of an effect that the model has: a search finds them beside minima that are the
// effect's own, where a rod that sticks has many.
#pragma once

#include <vector>

#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// Fits those of a first round's candidates that refine an effect of the model from further starts,
/// and keeps what leaves less: from the file's values and the stage's, with the size that leaves
/// least beside them, and where a refinement has no influence, as static friction below the sliding
/// one.
void refit_model_refinements(const SearchContext& context, const ModelStage& stage,
                             std::vector<Candidate>& candidates);

}  // namespace estimator::greybox::selection
