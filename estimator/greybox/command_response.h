// How the measured speed answers the command, from the record alone, whatever the plant.
//
//   c(L) = correlation of u(k - L) with y(k + 1) - y(k), both smoothed alike
//
// Passive plants take energy from the command: on the whole the speed goes with it, and c(0) of a
// servo, an axis with mass, damping and spring is not negative. The response is shifted in time
// where c(L) explains the command as no passive plant does without a shift,
//
//   u ~ d v + m a + k y + F sgn(v) + constant,   d, m, k, F >= 0.
//
// Motions of one frequency show no shift: a spring looks like one.
#pragma once

#include <cstddef>
#include <vector>

namespace estimator::greybox {

struct CommandResponse {
  double correlation = 0.0;  ///< c(0); 0 for a record too short to tell
  double delay_s = 0.0;  ///< by which the speed is behind the command; below 0: ahead; 0: no shift
  double exchanged = 0.0;  ///< c(0) of the two columns exchanged

  /// The motion feeds the command instead of following it.
  [[nodiscard]] bool against_command() const noexcept { return correlation < -0.7; }
  /// The command's derivative follows the position as a position's does its command: the two look
  /// exchanged. `exchanged` and the correlation have opposite signs, but for what the ends of a
  /// record add: the command of a closed loop that swings out comes near 1 too.
  [[nodiscard]] bool columns_exchanged() const noexcept {
    return exchanged > 0.99 && correlation < 0.5 && !against_command();
  }
  /// The command drives the motion: its sign is not turned.
  [[nodiscard]] bool with_command() const noexcept { return correlation > 0.1; }
};

/// `starts`: first sample of each segment but the first; the longest segment counts.
[[nodiscard]] CommandResponse command_response(double sample_time_s, const std::vector<double>& u_V,
                                               const std::vector<double>& y_m,
                                               const std::vector<std::size_t>& starts);

}  // namespace estimator::greybox
