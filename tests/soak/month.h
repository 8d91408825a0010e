// A month of the daemon in virtual time with random faults of devices, clocks, disk and peer
// (month_plan.h), every message of it accounted for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "tests/soak/month_plan.h"

namespace soak {

struct MonthOptions {
  std::filesystem::path config;  ///< config/demo.toml: its own faults are left out
  double hours = 720.0;
  std::uint64_t seed = 1;
  std::vector<std::string> more;  ///< table.key=value for the daemon
};

struct MonthResult {
  std::vector<std::string> problems;
  std::int64_t problem_count = 0;
  std::int64_t samples = 0;
  std::int64_t lost_periods = 0;
  std::int64_t sent = 0;      ///< messages
  std::int64_t unlogged = 0;  ///< of them: lost while the disk failed, and counted
};

/// Prints progress and figures on `out`. Throws std::exception when it cannot begin.
MonthResult run_month(const MonthOptions& options, std::ostream& out);

}  // namespace soak
