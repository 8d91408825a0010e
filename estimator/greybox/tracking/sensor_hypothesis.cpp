#include "estimator/greybox/tracking/sensor_hypothesis.h"

#include <cmath>
#include <numeric>
#include <utility>

namespace estimator::greybox::tracking {
namespace {

constexpr double kMostScale = 1.0 / 3.0;
constexpr double kMostDrift_mps = 0.01;
/// Steps of the parabola: in 1 / s, and in m/s.
constexpr double kScaleStep = 0.02;
constexpr double kDriftStep_mps = 1e-4;

/// Minimum of the parabola through (-step, a), (0, b), (step, c); NaN: none.
double least(double a, double b, double c, double step) {
  const double bend = a - 2.0 * b + c;
  return bend > 0.0 ? 0.5 * step * (a - c) / bend : NAN;
}

}  // namespace

std::vector<SensorHypothesis> sensor_hypotheses(WindowFit& fit, const WindowData& data,
                                                const Eigen::VectorXd& theta,
                                                const ErrorScales& errors, double sample_time_s) {
  const std::size_t all = data.lead + data.samples;
  const double* const end = data.y_m + all;
  const double centre_m =
      std::accumulate(data.y_m + data.lead, end, 0.0) / static_cast<double>(data.samples);
  const double middle = static_cast<double>(data.lead) + 0.5 * static_cast<double>(data.samples);
  SensorHypothesis scaled;
  scaled.name = "position_sensor.scale_ratio";
  SensorHypothesis drifting;
  drifting.name = "position_sensor.drift_mps";
  scaled.y_m.resize(all);
  drifting.y_m.resize(all);
  double position = 0.0;
  const auto by_scale = [&](double less) {  // 1 / s = 1 + less
    for (std::size_t k = 0; k < all; ++k) {
      scaled.y_m[k] = centre_m + (1.0 + less) * (data.y_m[k] - centre_m);
    }
    scaled.scale = 1.0 / (1.0 + less);
    scaled.value = scaled.scale - 1.0;
    const WindowFitSummary held = fit.fit(scaled.data(data), {}, theta, errors);
    position = held.position_chi_square;
    scaled.chi_square = held.chi_square;
    return scaled.chi_square;
  };
  const auto by_drift = [&](double rate_mps) {
    for (std::size_t k = 0; k < all; ++k) {
      drifting.y_m[k] = data.y_m[k] - rate_mps * sample_time_s * (static_cast<double>(k) - middle);
    }
    drifting.value = rate_mps;
    drifting.chi_square = fit.fit(drifting.data(data), {}, theta, errors).chi_square;
    return drifting.chi_square;
  };
  const double as_read = by_scale(0.0);
  std::vector<SensorHypothesis> found;
  const double less = least(by_scale(-kScaleStep), as_read, by_scale(kScaleStep), kScaleStep);
  if (std::abs(less) < kMostScale) {
    by_scale(less);
    scaled.chi_square += (scaled.scale * scaled.scale - 1.0) * position;
    found.push_back(std::move(scaled));
  }
  const double rate_mps =
      least(by_drift(-kDriftStep_mps), as_read, by_drift(kDriftStep_mps), kDriftStep_mps);
  if (std::abs(rate_mps) < kMostDrift_mps) {
    by_drift(rate_mps);
    found.push_back(std::move(drifting));
  }
  return found;
}

}  // namespace estimator::greybox::tracking
