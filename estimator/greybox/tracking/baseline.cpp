#include "estimator/greybox/tracking/baseline.h"

#include <algorithm>
#include <cmath>

#include "config/schema/error.h"
#include "estimator/greybox/dataset.h"

namespace estimator::greybox::tracking {
namespace {

using Eigen::Index;

/// Standard error, search units, up to which a window serves to learn what is healthy.
constexpr double kLeastKnown = 0.05;
/// Normal numbers: their standard deviation over the median of their distances.
constexpr double kOfMedian = 1.4826;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// What the windows say of a chamber; `spread_Pa`: of their offsets, as a standard deviation.
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

/// Not known where few windows had them, or the plant has none.
ChamberErrors learn_chambers(const std::vector<Window>& windows, const Choice& choice,
                             double rms_m) {
  std::vector<ChamberFit> in;
  std::vector<ChamberFit> out;
  std::size_t explained = 0;
  for (const Window& window : windows) {
    if (!window.explained) continue;
    ++explained;
    if (!std::isfinite(window.in.rms_Pa) || !std::isfinite(window.out.rms_Pa)) continue;
    in.push_back(window.in);
    out.push_back(window.out);
  }
  ChamberErrors errors;
  const double supply_Pa = choice.supply_Pa();
  if (!(supply_Pa > 0.0) || in.empty() || 2 * in.size() < explained) return errors;
  double in_spread_Pa = 0.0;
  double out_spread_Pa = 0.0;
  errors.in = median_of(in, rms_m, kLeastError_ratio * supply_Pa, in_spread_Pa);
  errors.out = median_of(out, rms_m, kLeastError_ratio * supply_Pa, out_spread_Pa);
  errors.offset_sd_Pa = std::max({kDrift_ratio * supply_Pa, in_spread_Pa, out_spread_Pa});
  return errors;
}

}  // namespace

bool teaches(const Window& window, const Choice& choice) {
  for (std::size_t i = 0; i < choice.tracked; ++i) {
    const Estimate& one = window.estimates[i];
    const double slope = choice.parameters[i].slope(one.x);
    if (!window.explained || !(one.std_error <= kLeastKnown * slope)) return false;
  }
  return window.explained;
}

Healthy learn(const std::vector<Window>& windows, const Choice& choice, double noise_floor_m,
              const std::string& where) {
  std::vector<double> rms_m;
  std::vector<std::vector<double>> x(choice.tracked);
  std::vector<std::string> why(choice.tracked, "has no whole window");
  for (const Window& window : windows) {
    if (window.explained) rms_m.push_back(window.rms_m);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Estimate& one = window.estimates[i];
      const SearchParameter& p = choice.parameters[i];
      if (!window.explained || !(one.std_error <= kLeastKnown * p.slope(one.x))) {
        why[i] = "has no usable window: " + one.why;
      } else {
        x[i].push_back(one.x);
      }
    }
  }
  Healthy healthy;
  healthy.x = choice.file;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i].empty()) {
      throw config::schema::bad_data(where, why[i], "a healthy motion that tells the parameters");
    }
    healthy.x[static_cast<Index>(i)] = median(x[i]);
  }
  healthy.rms_m = std::max({median(rms_m), noise_floor_m, kLeastFloor_m});
  healthy.chambers = learn_chambers(windows, choice, healthy.rms_m);
  return healthy;
}

}  // namespace estimator::greybox::tracking
