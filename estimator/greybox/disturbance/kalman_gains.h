// Gains of a Kalman filter along a linearised trajectory.
//
//   P <- A P A' + Q,   S = P_yy + R,   K = P c / S,   P <- (I - K c') P
//
// F is a first-order Markov process: decay exp(-2 pi corner Ts), stationary standard deviation
// `disturbance_sd`. The position walks by `walk_m` per sample, which is what the weak observer of a
// simulation assumes. Source: B. D. O. Anderson, J. B. Moore, Optimal Filtering (1979), chapter 4.
#pragma once

#include <span>
#include <vector>

#include "estimator/greybox/disturbance/linearisation.h"
#include "estimator/greybox/innovation_gains.h"

namespace estimator::greybox::disturbance {

struct NoiseParameters {
  double disturbance_sd = 0.0;  ///< N or m/s
  double corner_Hz = 1.0;
  double walk_m = 0.0;    ///< per sample
  double sensor_m = 0.0;  ///< standard deviation of the reading
};

struct KalmanGains {
  InnovationGains gains;         ///< scale: `floor_m` over the standard deviation of e; no lines
  double log_determinant = 0.0;  ///< sum over valid samples of log(S / floor_m^2)
};

/// Gains for each noise model, in its order; those of one do not depend on the others. `floor_m` >
/// 0 is the unit in which scaled innovations count.
[[nodiscard]] std::vector<KalmanGains> kalman_gains(const Linearisation& model,
                                                    const Dataset& record,
                                                    std::span<const NoiseParameters> noise,
                                                    double floor_m);
[[nodiscard]] KalmanGains kalman_gains(const Linearisation& model, const Dataset& record,
                                       const NoiseParameters& noise, double floor_m);

/// RMS of the weak observer's residual that this noise alone causes, m.
[[nodiscard]] double disturbed_rms_m(const Linearisation& model, const Dataset& record,
                                     const NoiseParameters& noise);

}  // namespace estimator::greybox::disturbance
