// The unit of a scale on which quantities of one size are set and drawn: that of quantity().
#pragma once

#include <string>
#include <string_view>

namespace config::units {

/// Value in SI = in_si * printed number.
struct PrintedScale {
  std::string unit;  ///< empty: a bare number
  double in_si = 1.0;
};

/// `name` and `size` as `name` and `reference` of quantity().
[[nodiscard]] PrintedScale printed_scale(std::string_view name, double size);

}  // namespace config::units
