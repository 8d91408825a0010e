// Result of the fit of one sliding window (parameter_tracker.h).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "estimator/greybox/tracking/change_naming.h"
#include "estimator/greybox/tracking/process_noise.h"
#include "estimator/greybox/tracking/window_validity.h"

namespace estimator::greybox::tracking {

struct ParameterEstimate {
  double theta = 0.0;      ///< search value
  double value = 0.0;      ///< SI
  double std_error = 0.0;  ///< SI
  double smallest = 0.0;   ///< change, SI, that this motion shows in 95 of 100 windows
  bool valid = false;
  InvalidReason invalid;  ///< Cause::none where valid
};

/// Fit of the latest part of a window whose whole length the model does not explain.
struct PartialFit {
  double length_s = 0.0;
  Eigen::VectorXd theta;      ///< every parameter, search units
  Eigen::VectorXd std_error;  ///< tracked parameters, search units
};

struct WindowResult {
  double t_s = 0.0;  ///< last sample
  double from_s = 0.0;
  std::vector<ParameterEstimate> estimates;  ///< one per tracked parameter, in their order
  Eigen::MatrixXd correlation;
  double rms_m = 0.0;
  ChamberFit in;  ///< NaN: chamber pressures were not used; same for `out`
  ChamberFit out;
  PressuresLeftOut left_out;              ///< none where the baseline has no chamber pressures
  bool fits = false;                      ///< the model explains the window
  bool explained = false;                 ///< the rod moves and the model explains the window
  bool poor = false;                      ///< the motion excites the parameters too little
  bool valid = false;                     ///< all estimates are valid
  InvalidReason invalid;                  ///< first reason; Cause::none where valid
  std::optional<PartialFit> part;         ///< latest part, where it was fitted
  std::vector<ParameterChange> named;     ///< changes, in this window or its latest part
  std::optional<DisturbanceLevel> level;  ///< present disturbance of a disturbed rig
  int evaluations = 0;                    ///< groups of eight simulations in the window's fit
  double fit_s = 0.0;                     ///< duration of the fit
};

}  // namespace estimator::greybox::tracking
