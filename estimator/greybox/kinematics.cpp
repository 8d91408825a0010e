#include "estimator/greybox/kinematics.h"

#include <algorithm>
#include <cmath>

#include "estimator/linear_algebra/decompositions.h"

namespace estimator::greybox {
namespace {

constexpr double kLongestReversal_s = 0.5;
constexpr double kReversalMargin_s = 0.05;
constexpr double kRestNoise = 4.0;
constexpr double kRestShare = 0.01;

/// Slope and curvature of the parabola through samples [from, to], evaluated at sample k.
struct Weights {
  std::vector<double> slope;
  std::vector<double> curvature;
};

Weights weights(std::ptrdiff_t first, std::ptrdiff_t last, double sample_time_s) {
  const auto count = static_cast<Eigen::Index>(last - first + 1);
  Eigen::MatrixXd powers(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double s = static_cast<double>(first + i);
    powers.row(i) << 1.0, s, s * s;
  }
  const Eigen::MatrixXd inverse = linear_algebra::solve_symmetric(
      powers.transpose() * powers, Eigen::MatrixXd(powers.transpose()));
  Weights result;
  for (Eigen::Index i = 0; i < count; ++i) {
    result.slope.push_back(inverse(1, i) / sample_time_s);
    result.curvature.push_back(2.0 * inverse(2, i) / (sample_time_s * sample_time_s));
  }
  return result;
}

double norm(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum);
}

void differentiate(const Dataset& record, const SampleRange& span, std::size_t half,
                   Kinematics& result) {
  const Weights inner = weights(-static_cast<std::ptrdiff_t>(half),
                                static_cast<std::ptrdiff_t>(half), record.sample_time_s);
  for (std::size_t k = span.begin; k < span.end; ++k) {
    const std::size_t from = k - std::min(half, k - span.begin);
    const std::size_t to = std::min(k + half, span.end - 1);
    const bool cut = to - from != 2 * half;
    const Weights w =
        cut ? weights(static_cast<std::ptrdiff_t>(from) - static_cast<std::ptrdiff_t>(k),
                      static_cast<std::ptrdiff_t>(to - k), record.sample_time_s)
            : Weights{};
    const Weights& used = cut ? w : inner;
    double v = 0.0;
    double a = 0.0;
    for (std::size_t i = from; i <= to; ++i) {
      const double y_m = record.y_m[i] - record.y_m[k];
      v += used.slope[i - from] * y_m;
      a += used.curvature[i - from] * y_m;
    }
    result.speed_mps[k] = v;
    result.acceleration_mps2[k] = a;
  }
}

int sign_of(double speed_mps, double rest_mps) {
  if (std::abs(speed_mps) < rest_mps) return 0;
  return speed_mps > 0.0 ? 1 : -1;
}

void direct(const Dataset& record, const SampleRange& span, Kinematics& result) {
  const std::size_t longest = samples_in(kLongestReversal_s, record.sample_time_s);
  const std::size_t margin = samples_in(kReversalMargin_s, record.sample_time_s);
  int last_sign = 0;
  std::size_t last = span.begin;
  for (std::size_t k = span.begin; k < span.end; ++k) {
    const int sign = sign_of(result.speed_mps[k], result.rest_mps);
    if (result.direction[k] != Direction::reversing) {
      result.direction[k] = sign == 0  ? Direction::resting
                            : sign > 0 ? Direction::extending
                                       : Direction::retracting;
    }
    if (sign == 0) continue;
    if (sign == -last_sign && k - last <= longest) {
      const std::size_t from = last - std::min(margin, last - span.begin);
      const std::size_t to = std::min(k + margin, span.end - 1);
      for (std::size_t i = from; i <= to; ++i) result.direction[i] = Direction::reversing;
    }
    last_sign = sign;
    last = k;
  }
}

}  // namespace

std::size_t samples_in(double duration_s, double sample_time_s) {
  return static_cast<std::size_t>(std::lround(duration_s / sample_time_s));
}

const char* to_string(Direction direction) noexcept {
  switch (direction) {
    case Direction::extending:
      return "extending";
    case Direction::retracting:
      return "retracting";
    case Direction::resting:
      return "at rest";
    case Direction::reversing:
      break;
  }
  return "reversing";
}

std::vector<SampleRange> segments(const Dataset& record) {
  std::vector<SampleRange> spans;
  for (std::size_t i = 0; i < record.starts.size(); ++i) {
    const std::size_t end = i + 1 < record.starts.size() ? record.starts[i + 1] : record.size();
    spans.push_back({record.starts[i], end});
  }
  return spans;
}

Kinematics kinematics(const Dataset& record, double noise_m) {
  Kinematics result;
  result.speed_mps.resize(record.size());
  result.acceleration_mps2.resize(record.size());
  result.direction.resize(record.size(), Direction::resting);
  const std::size_t half =
      std::max<std::size_t>(2, samples_in(kHalfWindow_s, record.sample_time_s));
  for (const SampleRange& span : segments(record)) differentiate(record, span, half, result);
  const Weights inner = weights(-static_cast<std::ptrdiff_t>(half),
                                static_cast<std::ptrdiff_t>(half), record.sample_time_s);
  const double rms_mps = norm(result.speed_mps) /
                         std::sqrt(static_cast<double>(std::max<std::size_t>(1, record.size())));
  result.rest_mps = std::max(kRestNoise * noise_m * norm(inner.slope), kRestShare * rms_mps);
  for (const SampleRange& span : segments(record)) direct(record, span, result);
  return result;
}

}  // namespace estimator::greybox
