// Speed, acceleration and direction of the measured rod at each sample, from the position alone;
// the model's errors are grouped by them.
//
//   y(t + s) ~ c0 + c1 s + c2 s^2  by least squares over |s| <= 50 ms   (Savitzky, Golay 1964)
//   v = c1,  a = 2 c2
//
// At least two samples to either side are used (at 50 Hz, 40 ms); at the ends of a segment the
// window is truncated and the parabola is evaluated off its middle. No sample of another segment is
// used.
#pragma once

#include <cstddef>
#include <vector>

#include "estimator/greybox/dataset.h"

namespace estimator::greybox {

enum class Direction { extending, retracting, resting, reversing };

[[nodiscard]] const char* to_string(Direction direction) noexcept;

struct Kinematics {
  std::vector<double> speed_mps;  ///< signed, positive extends
  std::vector<double> acceleration_mps2;
  std::vector<Direction> direction;
  double rest_mps = 0.0;  ///< speeds below count as at rest
};

inline constexpr double kHalfWindow_s = 0.05;

/// A rod slower than four standard deviations of the speed's noise, and slower than 1 % of its RMS
/// speed, is at rest; noise_m: noise of the position. "Reversing" lasts from 50 ms before the rod
/// leaves one direction until 50 ms after it moves the other way, where the reversal takes at most
/// 0.5 s.
[[nodiscard]] Kinematics kinematics(const Dataset& record, double noise_m);

/// First and one past the last sample of each segment.
struct SampleRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};
[[nodiscard]] std::vector<SampleRange> segments(const Dataset& record);

/// Whole number of samples nearest to a duration.
[[nodiscard]] std::size_t samples_in(double duration_s, double sample_time_s);

}  // namespace estimator::greybox
