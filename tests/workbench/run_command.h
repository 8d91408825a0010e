// Runs one command of the workbench in this process.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "workbench/cli/command.h"

namespace workbench_test {

/// Parses `arguments` (without the program's name) and so runs the command; errors are thrown as
/// `main` would see them. Returns the exit code that the command set.
int run_command(workbench::cli::Setup setup, std::vector<std::string> arguments);

/// The command's standard output; the command must set that exit code.
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
