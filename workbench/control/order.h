// Common part of every command to the running daemon: its socket, its answer as JSON, its refusal.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "daemon/control/protocol.h"

namespace workbench::control {

struct OrderOptions {
  std::string socket = monitor::control::kDefaultSocket;
  std::string json;  ///< file for the answer, "-" for standard output, empty: none
};

/// The daemon's answer, written where --json says. Throws config::schema::RunError when it is
/// a refusal, or when no daemon answers.
nlohmann::ordered_json give_order(const nlohmann::ordered_json& request,
                                  const OrderOptions& options);

/// Sends one request and returns the answer. Throws config::schema::RunError when no daemon
/// answers there within some seconds.
[[nodiscard]] nlohmann::ordered_json ask_daemon(const std::string& socket,
                                                const nlohmann::ordered_json& request);

}  // namespace workbench::control
