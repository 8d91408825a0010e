// The daemon's answer to `alarms`, as a table for people.
#pragma once

#include <iosfwd>
#include <nlohmann/json.hpp>

namespace workbench::control {

/// `all`: those that are normal too.
void print_alarms(const nlohmann::ordered_json& answer, bool all, std::ostream& out);

}  // namespace workbench::control
