// Sensitivity of innovations to a model's parameters where the predictor's gains follow them.
//
// The gains of a fit are frozen. Its Jacobian therefore takes it for information that another model
// would be corrected otherwise: a common scale of all pressures, masses and forces, of which the
// position shows nothing, would be known to a thousandth.
#pragma once

#include <Eigen/Core>

#include "estimator/greybox/selection/innovation_stage.h"

namespace estimator::greybox::selection {

/// d innovations / d theta (samples x parameters), scaled by the stage's own predictor; zero for
/// parameters at a bound.
[[nodiscard]] Eigen::MatrixXd innovation_jacobian(const InnovationStage& stage, unsigned threads);

}  // namespace estimator::greybox::selection
