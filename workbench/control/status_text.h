// The daemon's answer to `status`, as lines for people.
#pragma once

#include <iosfwd>
#include <nlohmann/json.hpp>

namespace workbench::control {

void print_status(const nlohmann::ordered_json& status, std::ostream& out);

}  // namespace workbench::control
