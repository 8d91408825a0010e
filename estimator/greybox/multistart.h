// Starting points of a multistart search: the model file's values first, then reproducible random
// values about them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/greybox/free_parameter.h"

namespace estimator::greybox {

/// Returns `count` points: the start, then samples of the priors. Without a prior a logarithm is
/// drawn with 0.5 about the start, the size of an effect within a factor of about three of the
/// start, or of its typical size where the effect starts from nothing.
[[nodiscard]] std::vector<Eigen::VectorXd> starting_points(
    const std::vector<FreeParameter>& parameters, const Eigen::VectorXd& start, int count);

}  // namespace estimator::greybox
