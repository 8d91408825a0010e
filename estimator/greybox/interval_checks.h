// Which parameters the standard error alone does not describe well, and their profiles.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/estimation.h"

namespace estimator::greybox {

/// One text for each parameter, empty where there is no doubt: at a bound, a large standard error
/// that no prior explains, or a cost that is not quadratic where the interval ends.
[[nodiscard]] std::vector<std::string> doubts(const estimator::nonlinear::Problem& problem,
                                              const estimator::nonlinear::Solution& solution,
                                              const estimator::nonlinear::Covariance& known,
                                              const std::vector<FreeParameter>& parameters,
                                              const Eigen::VectorXd& record_share);

/// Of the parameters whose `chosen` is not 0, on the task's threads; others stay empty.
[[nodiscard]] std::vector<estimator::nonlinear::Profile> profiles(
    const EstimationProblem& question, const EstimationOptions& options,
    const estimator::nonlinear::Problem& problem, const estimator::nonlinear::Solution& solution,
    const estimator::nonlinear::Covariance& known, const std::vector<char>& chosen);

/// What a profile says of a parameter, in the parameter's own unit.
void apply_profile(const estimator::nonlinear::Profile& walked, EstimatedParameter& q);

}  // namespace estimator::greybox
