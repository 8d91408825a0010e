#include "workbench/serve/detectable.h"

#include <cmath>

namespace workbench::serve {

DetectableChange detectable_change(double value, double std_error, double low, double high) {
  constexpr double kStdErrors = 2.0;
  const double noise = std::isfinite(std_error) ? kStdErrors * std_error : 0.0;
  const auto ratio = [&](double room) {
    if (room < 0.0) return 0.0;
    return (room + noise) / std::abs(value);  // NaN for a limit that is not there
  };
  return {ratio(value - low), ratio(high - value)};
}

}  // namespace workbench::serve
