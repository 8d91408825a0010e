// Hydraulic pressures that accompany a sample, on rigs that measure them.
#pragma once

#include <cmath>
#include <limits>

namespace config::signals {

/// Gauge pressures at the time of a sample; NaN: not read, or not to be used.
struct Pressures {
  double supply_Pa = std::numeric_limits<double>::quiet_NaN();
  double in_Pa = std::numeric_limits<double>::quiet_NaN();   ///< chamber that extends the rod
  double out_Pa = std::numeric_limits<double>::quiet_NaN();  ///< chamber that retracts it

  [[nodiscard]] bool chambers() const noexcept {
    return std::isfinite(in_Pa) && std::isfinite(out_Pa);
  }
};

}  // namespace config::signals
