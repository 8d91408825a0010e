// What every command to the running daemon shares: its socket, its answer as JSON, its refusal.
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

}  // namespace workbench::control
