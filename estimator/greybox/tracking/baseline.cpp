#include "estimator/greybox/tracking/baseline.h"

#include <algorithm>
#include <cmath>

#include "estimator/greybox/dataset.h"

namespace estimator::greybox::tracking {
namespace {

using Eigen::Index;

/// Standard error, search units, up to which a window qualifies for the baseline.
constexpr double kLeastKnown = 0.05;
/// Errors above this number of noise floors are not the sensor's.
constexpr double kAboveFloor = 1.5;
/// Standard deviation over median absolute deviation of a normal distribution.
constexpr double kOfMedian = 1.4826;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Medians of one chamber over the windows; `spread_Pa`: standard deviation of their offsets.
ChamberError median_of(const std::vector<ChamberFit>& windows, double rms_m, double least_Pa,
                       double& spread_Pa) {
  std::vector<double> rms_Pa;
  std::vector<double> mean_Pa;
  std::vector<double> weight_Pa;
  for (const ChamberFit& one : windows) {
    rms_Pa.push_back(one.rms_Pa);
    mean_Pa.push_back(one.mean_Pa);
    weight_Pa.push_back(one.weight_Pa_per_m * rms_m);
  }
  const ChamberError out{std::max(median(rms_Pa), least_Pa), median(mean_Pa),
                         std::max(median(weight_Pa), least_Pa)};
  for (double& value : mean_Pa) value = std::abs(value - out.offset_Pa);
  spread_Pa = kOfMedian * median(mean_Pa);
  return out;
}

/// Unknown where few windows had pressures, or the plant has none.
ChamberErrors learn_chambers(const std::vector<WindowResult>& windows, const ParameterSet& set,
                             double rms_m) {
  std::vector<ChamberFit> in;
  std::vector<ChamberFit> out;
  std::size_t explained = 0;
  for (const WindowResult& window : windows) {
    if (!window.explained) continue;
    ++explained;
    if (!std::isfinite(window.in.rms_Pa) || !std::isfinite(window.out.rms_Pa)) continue;
    in.push_back(window.in);
    out.push_back(window.out);
  }
  ChamberErrors errors;
  const double supply_Pa = set.supply_Pa();
  if (!(supply_Pa > 0.0) || in.empty() || 2 * in.size() < explained) return errors;
  double in_spread_Pa = 0.0;
  double out_spread_Pa = 0.0;
  errors.in = median_of(in, rms_m, kLeastError_ratio * supply_Pa, in_spread_Pa);
  errors.out = median_of(out, rms_m, kLeastError_ratio * supply_Pa, out_spread_Pa);
  errors.offset_sd_Pa = std::max({kDrift_ratio * supply_Pa, in_spread_Pa, out_spread_Pa});
  return errors;
}

/// True when parameter `i` of an explained window is known to some per cent.
bool determined(const WindowResult& window, const ParameterSet& set, std::size_t i) {
  const ParameterEstimate& one = window.estimates[i];
  return window.explained && one.std_error <= kLeastKnown * set.parameters[i].slope(one.theta);
}

}  // namespace

bool qualifies_for_baseline(const WindowResult& window, const ParameterSet& set) {
  for (std::size_t i = 0; i < set.tracked; ++i) {
    if (!determined(window, set, i)) return false;
  }
  return window.explained;
}

std::optional<std::size_t> undetermined_parameter(const std::vector<WindowResult>& windows,
                                                  const ParameterSet& set) {
  for (std::size_t i = 0; i < set.tracked; ++i) {
    if (std::none_of(windows.begin(), windows.end(),
                     [&](const WindowResult& window) { return determined(window, set, i); })) {
      return i;
    }
  }
  return std::nullopt;
}

bool look_disturbed(const std::vector<WindowResult>& windows, const ParameterSet& set,
                    double noise_floor_m) {
  std::vector<double> rms_m;
  for (const WindowResult& window : windows) {
    if (window.explained) rms_m.push_back(window.rms_m);
  }
  if (rms_m.empty() || !(median(rms_m) > kAboveFloor * noise_floor_m)) return false;
  for (std::size_t i = 0; i < set.tracked; ++i) {
    const auto known =
        std::count_if(windows.begin(), windows.end(),
                      [&](const WindowResult& window) { return determined(window, set, i); });
    if (2 * static_cast<std::size_t>(known) < rms_m.size()) return true;
  }
  return false;
}

Baseline learn_baseline(const std::vector<WindowResult>& windows, const ParameterSet& set,
                        double noise_floor_m) {
  std::vector<double> rms_m;
  std::vector<std::vector<double>> theta(set.tracked);
  for (const WindowResult& window : windows) {
    if (window.explained) rms_m.push_back(window.rms_m);
    for (std::size_t i = 0; i < theta.size(); ++i) {
      if (determined(window, set, i)) theta[i].push_back(window.estimates[i].theta);
    }
  }
  Baseline baseline;
  baseline.theta = set.file;
  for (std::size_t i = 0; i < theta.size(); ++i) {
    baseline.theta[static_cast<Index>(i)] = median(theta[i]);
  }
  baseline.rms_m = std::max({median(rms_m), noise_floor_m, kLeastFloor_m});
  baseline.chambers = learn_chambers(windows, set, baseline.rms_m);
  return baseline;
}

}  // namespace estimator::greybox::tracking
