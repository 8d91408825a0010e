// The direction in which a cylinder's parameters change without any change of its motion.
//
//   pressures, masses and forces by s,   flow per root of a pressure by 1/sqrt(s),
//   flow per pressure by 1/s             the same motion for any s
//
// Along it only the priors of the parameters say anything. Difference quotients of a simulation
// that sticks and slips are rough, and pass for information there.
#pragma once

#include <string>

#include "estimator/greybox/fit.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox {

/// Power of the scale s with which a parameter changes; 0: it does not.
[[nodiscard]] double pressure_scale_power(const std::string& name);

/// d theta of that direction, of arbitrary length; empty where something ties the parameters to an
/// absolute scale: one that is held, but for a return pressure whose prior is not 0 or at its
/// bound, a pressure that is given, a change, a formula that is not the same law at another scale.
[[nodiscard]] Eigen::VectorXd pressure_scale(const plant_sim::ModelFile& model,
                                             const FitSummary& fitted);

/// Removes the Jacobian's apparent information along pressure_scale().
void clear_pressure_scale(const plant_sim::ModelFile& model, FitSummary& fitted);

}  // namespace estimator::greybox
