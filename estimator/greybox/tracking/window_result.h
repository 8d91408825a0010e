// What one look at a sliding window found (tracker.h).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "estimator/greybox/tracking/change_naming.h"

namespace estimator::greybox::tracking {

struct ParameterEstimate {
  double theta = 0.0;      ///< search value
  double value = 0.0;      ///< SI
  double std_error = 0.0;  ///< SI
  double smallest = 0.0;   ///< change, SI, that this motion would show in 95 of 100 windows
  bool valid = false;
  std::string why;  ///< invalid: the reason
};

struct WindowResult {
  double t_s = 0.0;  ///< of its last sample
  double from_s = 0.0;
  std::vector<ParameterEstimate> estimates;  ///< of the tracked parameters, in their order
  Eigen::MatrixXd correlation;
  double rms_m = 0.0;
  ChamberFit in;  ///< NaN: chamber pressures did not count; as the next
  ChamberFit out;
  std::string left_out;                ///< why they did not, where the healthy rig knows them
  bool fits = false;                   ///< the model explains it
  bool explained = false;              ///< moves, and the model explains it
  bool poor = false;                   ///< it is the motion that does not tell
  bool valid = false;                  ///< all estimates are
  std::string why;                     ///< invalid: the first reason
  std::string part;                    ///< what its latest part said, where that was looked at
  std::vector<ParameterChange> named;  ///< changes, in this window or its latest part
  int evaluations = 0;                 ///< of the window's fit: groups of eight simulations
  double fit_s = 0.0;                  ///< time that it took
};

}  // namespace estimator::greybox::tracking
