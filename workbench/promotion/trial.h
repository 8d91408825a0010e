// A new model and the bands learned beside it, tried on records before they are let near the rig.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/record/record.h"
#include "estimator/fdi/band.h"
#include "estimator/fdi/pipeline.h"
#include "plant_sim/model_file.h"
#include "workbench/promotion/running_daemon.h"
#include "workbench/replay/backtest_runs.h"

namespace workbench::promotion {

/// The error of both models over all records, drift-corrected, each sample counting alike.
struct ModelTrial {
  double before_rms_m = 0.0;
  double after_rms_m = 0.0;
  double floor_m = 0.0;            ///< the lowest of the records'
  std::vector<std::string> notes;  ///< records left out, and why
  /// Larger by more than a hundredth: less is chance.
  [[nodiscard]] bool worse() const noexcept { return after_rms_m > 1.01 * before_rms_m; }
};

/// Throws config::schema::DataError when no record is left.
[[nodiscard]] ModelTrial try_model(const plant_sim::ModelFile& before,
                                   const plant_sim::ModelFile& after,
                                   const std::vector<config::record::Record>& records);

/// Limits that new bands would find passed on the records and the old ones do not, in words:
/// "period_gain at 12.3 s in FILE". `bands` beside the old file, under a unique name.
[[nodiscard]] std::vector<std::string> new_alarms(const RunningDaemon& daemon,
                                                  const std::filesystem::path& bands,
                                                  const std::vector<std::string>& files);

/// Bands on estimates, without limits of their own: a promotion learns theirs.
[[nodiscard]] std::vector<estimator::fdi::BandConfig> bands_to_learn(
    const estimator::fdi::PipelineConfig& rules);

/// False where the estimate of one of `bands` was INVALID for more than half of the run.
[[nodiscard]] bool has_judged(const replay::BacktestRun& run,
                              const std::vector<estimator::fdi::BandConfig>& bands);

/// The newest logs of the daemon's recorder in which its rules find no limit passed and the
/// estimates of bands_to_learn() are valid. Throws config::schema::RunError when there is none.
[[nodiscard]] std::vector<std::string> healthy_logs(const RunningDaemon& daemon);

}  // namespace workbench::promotion
