// How far a model is off, before and after a fit.
#pragma once

#include <Eigen/Core>

#include "estimator/greybox/estimation.h"

namespace estimator::greybox {

/// Fills the errors of the task's start and of `fitted` (search values); residual_m of both is
/// there already.
void find_errors(const Task& task, const Eigen::VectorXd& fitted, Errors& before, Errors& after);

}  // namespace estimator::greybox
