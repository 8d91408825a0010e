// An estimate of the running stand as the live page lists it: the fields of the message, and texts
// in the units of the reports.
#pragma once

#include <nlohmann/json.hpp>

namespace spoolwatch {
class estimate_t;
}

namespace workbench::serve {

/// As live::json() has it, and for each value "words", "text" with its standard error, "band", and
/// the changes that would be seen, "seen_down_ratio" and "seen_up_ratio". In the units of the axis
/// that the thread prints.
[[nodiscard]] nlohmann::ordered_json live_estimate(const spoolwatch::estimate_t& estimate);

}  // namespace workbench::serve
