// The client's end of the control socket: one request, one answer.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace workbench::control {

/// Sends one request and returns the answer. Throws config::schema::RunError when no daemon
/// answers there within some seconds.
[[nodiscard]] nlohmann::ordered_json ask_daemon(const std::string& socket,
                                                const nlohmann::ordered_json& request);

}  // namespace workbench::control
