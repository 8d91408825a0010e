// A long run of spoolwatchd in virtual time on the simulated rig with random faults, every message
// of it checked as it comes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace soak {

struct WeekOptions {
  std::filesystem::path config;  ///< config/demo.toml: its own faults are left out
  double hours = 168.0;
  std::uint64_t seed = 1;
  bool record = false;            ///< with the recorder, in a few small files
  std::vector<std::string> more;  ///< words for the daemon
};

struct WeekResult {
  std::vector<std::string> problems;
  std::int64_t problem_count = 0;
  std::int64_t samples = 0;
  std::size_t faults = 0;
  std::int64_t comings = 0;             ///< alarms that came
  std::int64_t resident_first_KiB = 0;  ///< at the end of the first hour, or of the first half
  std::int64_t resident_last_KiB = 0;
  double wall_s = 0.0;
};

/// Prints progress and a table on `out`. Throws std::exception when it cannot begin.
WeekResult run_week(const WeekOptions& options, std::ostream& out);

}  // namespace soak
