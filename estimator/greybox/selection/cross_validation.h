// Cross-validation of an addition where the remaining error exceeds the noise.
//
// Held-out blocks between fitted ones share the remaining systematic error, which an addition can
// follow in both. An addition therefore has to lower the error of either half of the records when
// fitted to the other; where noise does not explain the rest, in the free run without observer.
#pragma once

#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// `more` has the parameters of `plain` and further ones. `explained`: score with the observer.
[[nodiscard]] bool cross_validates(const SearchContext& context, bool explained,
                                   const ParameterSubset& plain, const ParameterSubset& more);

/// Whether noise explains the stage's held-out error.
[[nodiscard]] bool is_explained(const SearchContext& context, const ModelStage& stage);

}  // namespace estimator::greybox::selection
