// A line of units among the lines above a table: "s;V;mm", ",,,bar".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace config::record {

/// True where each field is a unit, in brackets or known, a dash or empty, and a unit is known.
/// Among more known units a short word may be one that is not: "s;V;cm;°C"; the first field may
/// lead them (leads_units).
[[nodiscard]] bool is_unit_line(const std::vector<std::string>& fields);

/// "Unit:", "Einheit", ...: in front of a line of units, itself none.
[[nodiscard]] bool leads_units(std::string_view field);

}  // namespace config::record
