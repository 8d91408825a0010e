#include "workbench/promotion/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "config/schema/error.h"
#include "estimator/fdi/quantity.h"
#include "estimator/greybox/validation/comparison.h"

namespace workbench::promotion {

namespace fdi = estimator::fdi;
namespace greybox = estimator::greybox;
namespace validation = estimator::greybox::validation;
namespace {

namespace fs = std::filesystem;
using config::schema::DataError;
using config::schema::RunError;

/// Alarms that come so near are the same one, as in `backtest`.
constexpr double kTolerance_s = 10.0;
constexpr std::size_t kMostLogs = 8;

replay::BacktestRules rules_with(const RunningDaemon& daemon, const fs::path& bands) {
  replay::BacktestRules rules;
  rules.file = daemon.config_file();
  rules.folder = daemon.folder();
  rules.pipeline = daemon.rules();
  rules.pipeline.bands_file = fs::absolute(bands).string();
  return rules;
}

}  // namespace

ModelTrial try_model(const plant_sim::ModelFile& before, const plant_sim::ModelFile& after,
                     const std::vector<config::record::Record>& records) {
  ModelTrial trial;
  trial.floor_m = std::numeric_limits<double>::quiet_NaN();
  double squares_before = 0.0;
  double squares_after = 0.0;
  double samples = 0.0;
  for (const config::record::Record& record : records) {
    try {
      const greybox::Dataset dataset = greybox::dataset_of(record);
      const validation::Comparison old_one = validation::compare(before, dataset);
      const validation::Comparison new_one = validation::compare(after, dataset);
      const auto n = static_cast<double>(dataset.size());
      squares_before += n * old_one.rms_m * old_one.rms_m;
      squares_after += n * new_one.rms_m * new_one.rms_m;
      samples += n;
      trial.floor_m = std::fmin(trial.floor_m, new_one.noise_floor_m);
    } catch (const DataError& e) {
      trial.notes.emplace_back(e.what());
    }
  }
  if (samples == 0.0) {
    throw config::schema::bad_data("the records",
                                   trial.notes.empty() ? "there is none" : trial.notes.front());
  }
  trial.before_rms_m = std::sqrt(squares_before / samples);
  trial.after_rms_m = std::sqrt(squares_after / samples);
  return trial;
}

std::vector<std::string> new_alarms(const RunningDaemon& daemon, const fs::path& bands,
                                    const std::vector<std::string>& files) {
  const auto runs = replay::run_backtest(rules_with(daemon, bands),
                                         rules_with(daemon, daemon.bands_file()), files);
  std::vector<std::string> found;
  for (const replay::BacktestRun& run : runs) {
    // INVALID says that periods were lost or nothing moved, which no band changes.
    const replay::OccurrenceDifference difference =
        replay::compare(replay::passed_limits(run.before), replay::passed_limits(run.after),
                        kTolerance_s, 0.5 * run.sample_time_s);
    for (const replay::Occurrence& each : difference.appears) {
      found.push_back(
          fmt::format("{} at {:.1f} s in {}", each.alarm, each.from_s, run.files.front()));
    }
  }
  return found;
}

std::vector<fdi::BandConfig> bands_to_learn(const fdi::PipelineConfig& rules) {
  std::vector<fdi::BandConfig> bands;
  std::copy_if(rules.bands.begin(), rules.bands.end(), std::back_inserter(bands),
               [](const fdi::BandConfig& band) {
                 return std::isinf(band.low) && std::isinf(band.high) &&
                        fdi::split_quantity(band.quantity).source != fdi::kSampleSource;
               });
  return bands;
}

bool has_judged(const replay::BacktestRun& run, const std::vector<fdi::BandConfig>& bands) {
  const double most_s = 0.5 * (run.to_s - run.from_s);
  return std::none_of(bands.begin(), bands.end(), [&](const fdi::BandConfig& band) {
    const std::string alarm =
        std::string(fdi::split_quantity(band.quantity).source) + "." + band.id;
    double invalid_s = 0.0;
    for (const replay::Occurrence& each : run.after) {
      if (each.alarm != alarm || !std::isnan(each.limit_s)) continue;
      invalid_s += (std::isnan(each.to_s) ? run.to_s : each.to_s) - each.from_s;
    }
    return invalid_s > most_s;
  });
}

std::vector<std::string> healthy_logs(const RunningDaemon& daemon) {
  std::vector<fs::path> logs;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(daemon.recorder_folder(), ignored)) {
    if (entry.path().extension() == ".lcmlog") logs.push_back(entry.path());
  }
  std::sort(logs.begin(), logs.end(), [&](const fs::path& a, const fs::path& b) {
    return fs::last_write_time(a, ignored) > fs::last_write_time(b, ignored);
  });
  std::vector<std::string> healthy;
  for (const fs::path& log : logs) {
    if (healthy.size() == kMostLogs) break;
    try {
      const auto runs = replay::run_backtest(rules_with(daemon, daemon.bands_file()), std::nullopt,
                                             {log.string()});
      if (replay::passed_limits(runs.front().after).empty() &&
          replay::passed_limits(runs.front().before).empty() &&
          has_judged(runs.front(), bands_to_learn(daemon.rules()))) {
        healthy.push_back(log.string());
      }
    } catch (const DataError&) {  // a log that cannot be replayed is no healthy one
    }
  }
  if (!healthy.empty()) return healthy;
  throw RunError("no log with valid estimates and without an alarm in the recorder's folder \"" +
                 daemon.recorder_folder().string() + "\"; allowed: healthy ones by --record");
}

}  // namespace workbench::promotion
