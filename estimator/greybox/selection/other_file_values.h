// Effects that stand in for a wrong value of the file: a force for a supply pressure beside a
// return pressure that is held.
#pragma once

#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// Gives up the effects that explain the record where the model does without them once the file's
/// values may be farther off than their priors' ranges, at no more cost than the evidence that
/// effects need; true where the problem has changed.
[[nodiscard]] bool prefer_other_file_values(const SearchContext& search, SearchStart& start,
                                            DiagnosisProblem& problem);

}  // namespace estimator::greybox::selection
