// Runs the fault detection over a folder of evidence again and compares its output with the
// recorded one, bit for bit.
//
// The log is the whole input. Samples go through the pipeline, restored from the folder's state.
// Alarms that do not come from the pipeline (guards, the daemon's own) and the acts of people are
// taken from the log at their place, since they may decide which alarm is the first of a burst, or
// what is still latched.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "estimator/fdi/pipeline.h"
#include "estimator/fdi/tracker/detection_method_kinds.h"

namespace workbench::replay {

namespace tracker = estimator::fdi::tracker;

/// A folder of evidence as the daemon writes it, read and checked.
struct Pack {
  std::filesystem::path log;
  std::string rig_id, prefix;
  double sample_time_s = 0.0;
  estimator::fdi::PipelineConfig pipeline{tracker::detection_method_kinds()};
  std::uint64_t pipeline_hash = 0;
  std::vector<std::uint8_t> state;  ///< before the first sample
  std::int64_t first_tick = 0;
  std::string source, name, utc;  ///< identify the alarm
  std::int64_t tick = 0;
};

/// Throws config::schema::DataError for what is no such folder, damaged, or cannot be
/// replayed.
[[nodiscard]] Pack read_pack(const std::filesystem::path& folder);

struct ReplayOutcome {
  std::int64_t samples = 0;
  std::int64_t estimates = 0, estimates_same = 0;
  std::int64_t alarms = 0, alarms_same = 0;  ///< changes published by the pipeline
  bool derived = false;                      ///< the folder's alarm comes from the pipeline
  bool found = false;                        ///< it was raised again
  bool alarm_same = false;                   ///< with the same bits
  estimator::fdi::Alarm alarm{};             ///< as raised again
  std::vector<std::string> differences{};    ///< the first few, in words

  [[nodiscard]] bool same() const noexcept {
    return estimates == estimates_same && alarms == alarms_same && found && alarm_same;
  }
};

/// Throws config::schema::DataError ( 78) for a folder that is damaged.
[[nodiscard]] ReplayOutcome replay(const Pack& pack);

}  // namespace workbench::replay
