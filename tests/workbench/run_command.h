// Runs one command of the workbench in this process.
#pragma once

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "workbench/cli/command.h"

namespace workbench_test {

/// Parses `arguments` (without the program's name) and so runs the command; errors are thrown as
/// `main` would see them. Returns the exit code that the command set.
inline int run_command(workbench::cli::Setup setup, std::vector<std::string> arguments) {
  CLI::App app;
  int exit_code = 0;
  setup(app, exit_code);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
  app.parse(arguments);
  return exit_code;
}

/// What the command prints, while it is expected to set that exit code.
inline std::string printed_by(workbench::cli::Setup setup, std::vector<std::string> arguments,
                              int exit_code = 0) {
  testing::internal::CaptureStdout();
  try {
    EXPECT_EQ(run_command(setup, std::move(arguments)), exit_code);
  } catch (...) {
    testing::internal::GetCapturedStdout();
    throw;
  }
  std::fflush(stdout);
  return testing::internal::GetCapturedStdout();
}

}  // namespace workbench_test
