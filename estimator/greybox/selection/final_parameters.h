// The better model of a diagnosis: its parameters on all samples, with their errors.
#pragma once

#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/innovation_stage.h"

namespace estimator::greybox::selection {

/// Fits the final model of the search: by its errors under the observer where noise explains them,
/// otherwise to a free run.
void fit_final_parameters(const SearchContext& context, Diagnosis& result);

/// Takes the model that the innovations chose, as it is.
void take_parameters(InnovationStage stage, Diagnosis& result);

/// Takes the model file as the better model of an interrupted search that leaves more on held-out
/// data: the best so far may be that of a fit which had only begun.
void keep_file_where_better(const SearchContext& context, Diagnosis& result);

}  // namespace estimator::greybox::selection
