// A log of the daemon on the simulated rig, made in virtual time.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/daemon/program/subprocess.h"

namespace live_test {

/// `seconds` of the thesis's motion before its first fault (15 s) unless `more` says otherwise.
inline std::string make_log(const std::filesystem::path& folder, const std::string& seconds,
                            const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments =
      program::virtual_run(program::shipped("thesis_case1.toml"), folder, more);
  arguments.insert(arguments.end(), {"--duration", seconds});
  const program::Result result = program::run(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    return entry.path().string();
  }
  return "";
}

}  // namespace live_test
