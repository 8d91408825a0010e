// A line of units among the lines above a table: "s;V;mm", ",,,bar".
#pragma once

#include <string>
#include <vector>

namespace config::record {

/// True where each field is a unit, in brackets or known, a dash or empty, and a unit is known.
/// Among more known units a short word may be one that is not: "s;V;cm;°C".
[[nodiscard]] bool is_unit_line(const std::vector<std::string>& fields);

}  // namespace config::record
