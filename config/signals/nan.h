// The missing number.
#pragma once

#include <limits>

namespace config::signals {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace config::signals
