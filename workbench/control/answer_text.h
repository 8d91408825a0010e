// Answers of the running daemon as text for people.
#pragma once

#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

namespace workbench::control {

/// The answer to `alarms` as a table. `all`: those that are normal too.
void print_alarms(const nlohmann::ordered_json& answer, bool all, std::ostream& out);

/// The answer to `status` as lines.
void print_status(const nlohmann::ordered_json& status, std::ostream& out);

}  // namespace workbench::control
