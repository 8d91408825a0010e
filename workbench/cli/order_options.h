// Options of every command that asks or orders the running daemon.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "workbench/control/order.h"

namespace workbench::cli {

/// --socket, else the environment's SPOOLWATCH_SOCKET, else the service's socket.
inline void add_socket(CLI::App& command, std::string& socket) {
  command.add_option("--socket", socket, "control socket of the daemon")
      ->envname("SPOOLWATCH_SOCKET")
      ->capture_default_str();
}

/// --socket and --json, which those commands share; `options` outlives the parsing.
inline void add_order_options(CLI::App& command, control::OrderOptions& options) {
  add_socket(command, options.socket);
  command.add_option("--json", options.json, "write the answer there; - for standard output");
}

}  // namespace workbench::cli
