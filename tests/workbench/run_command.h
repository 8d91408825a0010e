// Runs one command of the workbench in this process.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "workbench/command.h"

namespace workbench_test {

/// Parses `arguments` (without the program's name) and so runs the command; errors are thrown as
/// `main` would see them. Returns the exit code that the command set.
inline int run_command(workbench::Setup setup, std::vector<std::string> arguments) {
  CLI::App app;
  int exit_code = 0;
  setup(app, exit_code);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
  app.parse(arguments);
  return exit_code;
}

}  // namespace workbench_test
