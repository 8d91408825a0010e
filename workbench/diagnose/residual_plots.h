// Plots of residuals over what they may depend on, as the sections of a report share them.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/kinematics.h"
#include "workbench/present/report.h"

namespace workbench::diagnose {

/// A variable of the motion, in the unit that it is drawn in.
struct MotionVariable {
  present::Axis axis;
  std::vector<double> values;
};

/// Velocity, position, command and acceleration.
[[nodiscard]] std::vector<MotionVariable> motion_variables(
    const estimator::greybox::Dataset& record, const estimator::greybox::Kinematics& kinematics);

/// An even selection of the points and their outline.
[[nodiscard]] present::Series cloud(const std::string& name, const std::vector<double>& x,
                                    const std::vector<double>& y, present::Tone tone);
/// Mean of y over stretches of x.
[[nodiscard]] present::Series mean_curve(const std::string& name, const std::vector<double>& x,
                                         const std::vector<double>& y, present::Tone tone);

/// Share of the variance of y that its mean over stretches of x holds.
[[nodiscard]] double shape_share(const std::vector<double>& x, const std::vector<double>& y);

[[nodiscard]] std::vector<double> scaled(std::vector<double> values, double factor);

}  // namespace workbench::diagnose
