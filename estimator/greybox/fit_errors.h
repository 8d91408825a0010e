// Errors of a model before and after a fit.
#pragma once

#include <Eigen/Core>

#include "estimator/greybox/estimation.h"

namespace estimator::greybox {

/// Fills the errors of the start and of `fitted`; residual_m of both is already set.
void compute_errors(const EstimationProblem& question, const Eigen::VectorXd& fitted,
                    SimulationErrors& before, SimulationErrors& after);

}  // namespace estimator::greybox
