// Parameters whose standard error alone describes the uncertainty badly, and their profiles.
#pragma once

#include <vector>

#include "estimator/greybox/estimation.h"

namespace estimator::greybox {

/// One entry per parameter.
[[nodiscard]] std::vector<IntervalDoubt> doubts(const estimator::nonlinear::Problem& problem,
                                                const estimator::nonlinear::Solution& solution,
                                                const estimator::nonlinear::Covariance& known,
                                                const std::vector<FreeParameter>& parameters,
                                                const Eigen::VectorXd& record_share);

/// Profiles of the parameters with `chosen` not 0, computed in parallel; the others stay empty.
[[nodiscard]] std::vector<estimator::nonlinear::Profile> profiles(
    const EstimationProblem& question, const EstimationOptions& options,
    const estimator::nonlinear::Problem& problem, const estimator::nonlinear::Solution& solution,
    const estimator::nonlinear::Covariance& known, const std::vector<char>& chosen);

/// Stores the profile and its interval in `q`, in the parameter's physical unit.
void apply_profile(const estimator::nonlinear::Profile& walked, EstimatedParameter& q);

}  // namespace estimator::greybox
