// How far a model is off, before and after a fit.
#pragma once

#include <Eigen/Core>

#include "estimator/greybox/estimation.h"

namespace estimator::greybox {

/// Fills the errors of the task's start and of `fitted` (search values); residual_m of both is
/// there already.
void compute_errors(const EstimationProblem& question, const Eigen::VectorXd& fitted,
                    SimulationErrors& before, SimulationErrors& after);

}  // namespace estimator::greybox
