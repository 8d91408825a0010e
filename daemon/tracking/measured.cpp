#include "daemon/tracking/measured.h"

#include <algorithm>

namespace monitor::tracking {
namespace {

/// Of the error in one sample, where samples are far apart.
constexpr double kMostLed = 0.5;

}  // namespace

double Measured::share(std::size_t k, double observer_per_s) const noexcept {
  const double observed = observer_per_s * sample_time_s;
  if (k >= led.size() || led[k] == kNotLed) return observed;
  if (led[k] == kLedWhereObserved && !(observer_per_s > 0.0)) return observed;
  return std::max(observed, std::min(kMostLed, kLeading_per_s * sample_time_s));
}

}  // namespace monitor::tracking
