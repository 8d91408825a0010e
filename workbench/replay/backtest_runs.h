// Old logs through a new configuration: the alarms of each run of the daemon by the new rules,
// beside those by the old rules or as recorded.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/record/reading.h"
#include "estimator/fdi/pipeline.h"
#include "estimator/fdi/tracker/detection_method_kinds.h"
#include "workbench/replay/occurrences.h"

namespace workbench::replay {

namespace tracker = estimator::fdi::tracker;

/// The alarms' part of a configuration file.
struct BacktestRules {
  std::string file;
  std::filesystem::path folder;  ///< bands_file starts here
  std::string rig_id;            ///< "" where the file does not say
  estimator::fdi::PipelineConfig pipeline{tracker::detection_method_kinds()};
};

/// Throws config::schema::ConfigError.
[[nodiscard]] BacktestRules read_rules(const std::string& file);

/// One run of the daemon, or one CSV record.
struct BacktestRun {
  std::vector<std::string> files;  ///< in the order of time
  double sample_time_s = 0.0;
  double from_s = 0.0, to_s = 0.0;  ///< first and last sample
  std::int64_t samples = 0;
  bool has_recorded_alarms = false;  ///< a CSV record has none
  std::vector<Occurrence> after;     ///< by the new rules
  std::vector<Occurrence> before;    ///< by the old ones, or as recorded
};

/// `logs`: LCM event logs, folders of them, records. Logs of one run are put together. `old_rules`
/// empty: what was recorded. Throws config::schema::DataError.
[[nodiscard]] std::vector<BacktestRun> run_backtest(
    const BacktestRules& new_rules, const std::optional<BacktestRules>& old_rules,
    const std::vector<std::string>& logs, const config::record::ReadOptions& reading = {});

}  // namespace workbench::replay
