#include "daemon/tracking/healthy.h"

#include <algorithm>

#include "config/schema/error.h"
#include "daemon/tracking/least_floor.h"

namespace monitor::tracking {
namespace {

using Eigen::Index;

/// Standard error, search units, up to which a window serves to learn what is healthy.
constexpr double kLeastKnown = 0.05;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
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
  return healthy;
}

}  // namespace monitor::tracking
