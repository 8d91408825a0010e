// Answers of the running daemon as text for people.
#pragma once

#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace workbench::control {

/// The answer to `alarms` as a table. `all`: those that are normal too.
void print_alarms(const nlohmann::ordered_json& answer, bool all, std::ostream& out);

/// What one source would detect now, of the answer to `status`.
struct DetectableLines {
  std::string smallest;           ///< "track would detect now: supply pressure 2.1 bar, ..."
  std::vector<std::string> more;  ///< why not less, and what disturbs the rig
};
[[nodiscard]] std::vector<DetectableLines> detectable_lines(const nlohmann::ordered_json& status);

/// The answer to `status` as lines.
void print_status(const nlohmann::ordered_json& status, std::ostream& out);

}  // namespace workbench::control
