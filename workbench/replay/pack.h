// A folder of evidence as the daemon writes it, read and checked.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "estimator/fdi/pipeline.h"
#include "estimator/fdi/tracker/detection_method_kinds.h"

namespace workbench::replay {

namespace tracker = estimator::fdi::tracker;

struct Pack {
  std::filesystem::path log;
  std::string rig_id, prefix;
  double sample_time_s = 0.0;
  estimator::fdi::PipelineConfig pipeline{tracker::detection_method_kinds()};
  std::uint64_t pipeline_hash = 0;
  std::vector<std::uint8_t> state;  ///< before the first sample
  std::int64_t first_tick = 0;
  std::string source, name, utc;  ///< of the alarm
  std::int64_t tick = 0;
};

/// Throws config::schema::DataError for what is no such folder, damaged, or cannot be
/// replayed.
[[nodiscard]] Pack read_pack(const std::filesystem::path& folder);

}  // namespace workbench::replay
