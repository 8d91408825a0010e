// Options of every command that asks or orders the running daemon.
#pragma once

#include <CLI/CLI.hpp>

#include "workbench/control/order.h"

namespace workbench::cli {

/// --socket and --json, which those commands share; `options` outlives the parsing.
inline void add_order_options(CLI::App& command, control::OrderOptions& options) {
  command.add_option("--socket", options.socket, "control socket of the daemon")
      ->capture_default_str();
  command.add_option("--json", options.json, "write the answer there; - for standard output");
}

}  // namespace workbench::cli
