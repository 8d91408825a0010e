// Differences between records: a parameter of the model that has another value in one of them.
#pragma once

#include "estimator/greybox/selection/diagnosis.h"

namespace estimator::greybox::selection {

/// Takes up to three parameters that differ between records where that makes several records
/// clearly likelier than the effects found, and explains them. False: `result` is as before.
bool find_record_differences(const SearchContext& context, const ModelStage& first,
                             Diagnosis& result);

}  // namespace estimator::greybox::selection
