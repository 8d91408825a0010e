// Backward elimination of a stage, then forward addition of refinements.
#pragma once

#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// Pass within the search, or the final one over its result.
enum class EliminationPass { intermediate, final };

/// Drops effects, then refinements of effects, as long as the held-out error suffers less than an
/// effect must bring (and refinements without support.h's support where the error is more than
/// noise); then tries refinements that did not take part, which need that support too. On the way,
/// a stage that noise does not explain keeps its refinements as they are: their support takes long.
void eliminate_backward(const SearchContext& context, ModelStage& stage, EliminationPass look);

/// Fits a stage to the end, beside it without each refinement of its effects: where that ends
/// lower, and noise does not explain the stage, the refinement goes. Its search has ended somewhere
/// wrong, and holds the others' there.
void refit_without_refinements(const SearchContext& context, ModelStage& stage);

}  // namespace estimator::greybox::selection
