// The messages of a recorded log, by type.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/pressures_t.hpp"
#include "spoolwatch/rods_t.hpp"
#include "spoolwatch/sample_t.hpp"

namespace program {

struct Log {
  std::vector<spoolwatch::sample_t> samples;
  std::vector<spoolwatch::rods_t> rods;
  std::vector<spoolwatch::pressures_t> pressures;
  std::vector<spoolwatch::estimate_t> estimates;
  std::vector<spoolwatch::alarm_t> alarms;
  std::vector<spoolwatch::health_t> healths;

  /// Changes of one alarm, without repeats: "18.0 on, 32.0 off".
  [[nodiscard]] std::string timeline(const std::string& name, double sample_time_s) const;
};

/// All files of the folder in order.
Log read_log(const std::filesystem::path& folder);
/// The bytes of all files of the folder, in order of their names.
std::string bytes(const std::filesystem::path& folder);

}  // namespace program
