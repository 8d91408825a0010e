// Position sensor hypothesis: a scale or a drift of the reading in place of a change of the rig.
//
//   scale   y' = yc + (y - yc) / s        drift   y' = y - r (t - tc)
//
// y  reading    y'  true position under the hypothesis    yc tc  middle of the window
//
// The model is compared with y'. The residual is linear in 1 / s and in r, apart from the plant's
// weak dependence on y: chi-square is a parabola, given by three values. It is evaluated in the
// reading's own noise, that is times s^2; the chamber pressures' part stays unchanged.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/greybox/tracking/window_fit.h"

namespace estimator::greybox::tracking {

/// A window corrected for a faulty sensor.
struct SensorHypothesis {
  const char* name = "";  ///< position_sensor.scale_ratio (its change), position_sensor.drift_mps
  double value = 0.0;
  double scale = 1.0;  ///< s: residuals of the corrected window times s are in the reading's noise
  double chi_square = 0.0;
  std::vector<double> y_m;  ///< y', lead-in and window

  [[nodiscard]] WindowData data(const WindowData& as_read) const {
    WindowData right = as_read;
    right.y_m = y_m.data();
    return right;
  }
};

/// Scale and drift that explain the window best with the model at `x`; values beyond a plausible
/// sensor fault (a third, 10 mm/s) are left out.
[[nodiscard]] std::vector<SensorHypothesis> sensor_hypotheses(WindowFit& fit,
                                                              const WindowData& data,
                                                              const Eigen::VectorXd& theta,
                                                              const ErrorScales& errors,
                                                              double sample_time_s);

}  // namespace estimator::greybox::tracking
