#include "estimator/greybox/clock_shift.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "estimator/greybox/kinematics.h"

namespace estimator::greybox {
namespace {

using Eigen::Index;

/// The response misses a shift by the plant's time constants: shifts as far from the best so far
/// are compared.
constexpr double kBeside_s = 0.03;
constexpr Index kLeastBeside = 3;
/// Positions so far apart show the speed; those of two samples may show the noise.
constexpr double kSpeedOver_s = 0.02;
/// Share of the motion that may remain unexplained, of that which the command as logged leaves.
constexpr double kShiftLeaves = 0.5;
constexpr Index kFewestCompared = 100;

SampleRange longest_span(const Dataset& record) {
  SampleRange longest{0, 0};
  for (const SampleRange& span : segments(record)) {
    if (span.end - span.begin > longest.end - longest.begin) longest = span;
  }
  return longest;
}

double motions_correlate(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::ArrayXd x = a.array() - a.mean();
  const Eigen::ArrayXd y = b.array() - b.mean();
  const double scale = std::sqrt((x * x).sum() * (y * y).sum());
  return scale > 0.0 ? (x * y).sum() / scale : 0.0;
}

}  // namespace

double command_late_samples(const Dataset& record, const std::vector<double>& speed_mps,
                            double by_response) {
  const SampleRange span = longest_span(record);
  const auto width =
      std::max(Index{1}, static_cast<Index>(std::lround(kSpeedOver_s / record.sample_time_s)));
  const auto beside =
      std::max(kLeastBeside, static_cast<Index>(std::lround(kBeside_s / record.sample_time_s)));
  const Index samples = static_cast<Index>(span.end - span.begin) - width;
  const Index farthest = samples - kFewestCompared;
  Index best = std::max(Index{1}, static_cast<Index>(std::lround(by_response)));
  if (best > farthest) return 0.0;
  Eigen::VectorXd measured_m(samples);
  Eigen::VectorXd modelled_mps = Eigen::VectorXd::Zero(samples);
  for (Index k = 0; k < samples; ++k) {
    const std::size_t at = span.begin + static_cast<std::size_t>(k);
    measured_m[k] = record.y_m[at + static_cast<std::size_t>(width)] - record.y_m[at];
    for (std::size_t i = 0; i < static_cast<std::size_t>(width); ++i) {
      modelled_mps[k] += 0.5 * (speed_mps[at + i] + speed_mps[at + i + 1]);
    }
  }
  const auto left = [&](Index lag) {
    const double c =
        motions_correlate(measured_m.head(samples - lag), modelled_mps.tail(samples - lag));
    return c > 0.0 ? 1.0 - c * c : 1.0;
  };
  double least = left(best);
  for (Index centre = 0; centre != best;) {
    centre = best;
    const Index last = std::min(centre + beside, farthest);
    for (Index lag = std::max(Index{1}, centre - beside); lag <= last; ++lag) {
      const double here = left(lag);
      if (here < least) {
        least = here;
        best = lag;
      }
    }
  }
  return least < kShiftLeaves * left(0) ? static_cast<double>(best) : 0.0;
}

}  // namespace estimator::greybox
