// Backward elimination of a stage, then forward addition of refinements.
#pragma once

#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// Pass within the search, or the final one over its result.
enum class EliminationPass { intermediate, final };

/// Drops effects, then refinements, as long as the held-out error rises by less than an effect must
/// gain (and refinements that fail CrossValidation where the error exceeds the noise); then tries
/// refinements that were left out, which must pass it as well. Intermediate passes keep the
/// refinements of a stage that noise does not explain, because their cross-validation takes long.
void eliminate_backward(const SearchContext& context, CrossValidation& halves, ModelStage& stage,
                        EliminationPass look);

/// Fits a stage to convergence, and in parallel without each refinement of its effects. A
/// refinement is dropped where the fit without it ends lower and noise does not explain the stage:
/// the search then ended in a wrong minimum.
void refit_without_refinements(const SearchContext& context, ModelStage& stage);

}  // namespace estimator::greybox::selection
