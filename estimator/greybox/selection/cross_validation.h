// Whether an addition to a model holds on data that it was not fitted to, when what is left of the
// error is more than noise.
//
// Held-out blocks between fitted ones share whatever is still wrong; an addition can follow that in
// both. So it has to lower the error of either half of the records when it is fitted to the other,
// and where noise does not explain the rest, without the observer's help: in the free run.
#pragma once

#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

/// `more` has the parameters of `plain` and others. With `explained` the observer helps.
[[nodiscard]] bool cross_validates(const SearchContext& context, bool explained,
                                   const ParameterSubset& plain, const ParameterSubset& more);

/// Whether noise explains what is left of the stage's held-out error.
[[nodiscard]] bool is_explained(const SearchContext& context, const ModelStage& stage);

}  // namespace estimator::greybox::selection
