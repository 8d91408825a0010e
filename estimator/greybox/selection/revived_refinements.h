// Refinements without influence, such as static friction below the sliding one: no gradient leads a
// fit out of there, only another start.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/greybox/fit.h"

namespace estimator::greybox::selection {

/// Starts in which refinements that have no influence at the fit's solution have one again: sizes
/// in the unit of the effect's first parameter in the library's proportion to it, others at a
/// third, the whole and three times the typical size. None where all have influence, or without a
/// Jacobian.
[[nodiscard]] std::vector<Eigen::VectorXd> revived_refinements(const FitSummary& fitted);

}  // namespace estimator::greybox::selection
