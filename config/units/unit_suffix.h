// The unit that the suffix of a name states: "damping_N_s_per_m" is in N s/m.
#pragma once

#include <string>
#include <string_view>

namespace config::units {

/// "N s/m" for "damping_N_s_per_m"; "" for a number without a unit.
[[nodiscard]] std::string unit_of(std::string_view name);

}  // namespace config::units
