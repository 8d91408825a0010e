// Hours of spoolwatchd in virtual time on the healthy simulated rig, with physical parameters
// tracked: as one run, in which every alarm is a false one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/soak/fault_plan.h"

namespace soak {

struct QuietOptions {
  std::filesystem::path config;  ///< its own faults are left out
  double hours = 10.0;
  std::uint64_t seed = 1;  ///< seeds the noise
  std::vector<Fault> faults;
};

struct QuietResult {
  std::int64_t samples = 0;
  std::int64_t estimates = 0;       ///< the tracker's
  std::int64_t valid = 0;           ///< valid ones among them
  std::vector<std::string> alarms;  ///< that came: second, source and name
  int exit_code = 0;                ///< the daemon's
  std::string err;                  ///< what it wrote
};

/// Throws std::exception when it cannot begin.
QuietResult run_quiet(const QuietOptions& options);

}  // namespace soak
