#include "tests/workbench/run_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace workbench_test {

int run_command(workbench::cli::Setup setup, std::vector<std::string> arguments) {
  CLI::App app;
  int exit_code = 0;
  setup(app, exit_code);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
  app.parse(arguments);
  return exit_code;
}

}  // namespace workbench_test
