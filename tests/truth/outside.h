// Disturbances of a rig from outside, which follow from neither command nor motion.
//
//   force     dF = -w F dt + sqrt(2 w) s dW,  w = 2 pi corner: first-order low-passed white noise
//   supply    Ps + a sin(2 pi f t + phase): a pump's pulsation
//   sensor    reading + a sin(2 pi f t + phase): a mount that shakes
//   line      F = a sin(2 pi f t + phase): a force with one frequency, such as an unbalance
//
// The force is stepped exactly for steps of 1 ms and held in between.
#pragma once

#include <cstddef>

#include "tests/truth/motion.h"

namespace truth {

struct Outside {
  double force_N = 0.0;  ///< RMS
  double corner_Hz = 3.0;
  double pulsation_Pa = 0.0;
  double pulsation_Hz = 23.0;
  double shake_m = 0.0;
  double shake_Hz = 37.0;
  double line_N = 0.0;
  double line_Hz = 19.0;

  [[nodiscard]] bool any() const {
    return force_N > 0.0 || pulsation_Pa > 0.0 || shake_m > 0.0 || line_N > 0.0;
  }
};

/// The disturbances of one record along its time.
class Disturber {
 public:
  Disturber(const Outside& outside, std::size_t seed);
  /// Random part and line; to be called with times that do not fall.
  double force_N(double t_s);
  [[nodiscard]] double pulsation_Pa(double t_s) const;
  [[nodiscard]] double shake_m(double t_s) const;

 private:
  Outside outside_;
  Random random_;
  double pulsation_rad_, shake_rad_, line_rad_;
  double now_N_;
  double next_s_;
};

}  // namespace truth
