// `spoolwatch calibrate CONFIG.toml RECORD -o bands.toml`: alarm bands learned from a healthy
// record, with the configuration's own estimators. The method: estimator/fdi/learn.h.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>

#include "config/record/record.h"
#include "config/record/whole_file.h"
#include "config/schema/document.h"
#include "config/schema/error.h"
#include "estimator/fdi/learn.h"
#include "estimator/fdi/learned_bands.h"
#include "estimator/fdi/pipeline.h"
#include "workbench/command.h"
#include "workbench/number_check.h"
#include "workbench/record_samples.h"

namespace workbench {
namespace {

namespace fdi = estimator::fdi;
using config::schema::bad_config;

struct Options {
  std::string config;
  std::string record;
  std::string out;
  std::vector<std::string> quantities;
  double false_alarm_time_s = 86400.0;
  double period_s = std::numeric_limits<double>::quiet_NaN();
};

/// One quantity's values, one for each estimate.
struct Series {
  std::string quantity;
  std::size_t estimator = 0;
  std::string_view name;
  std::vector<double> values{};  ///< NaN where the estimate is not valid
  double error_sum = 0.0;
  std::size_t valid = 0;
};

class Collector final : public fdi::Events {
 public:
  explicit Collector(std::vector<Series>& series) : series_(series) {}
  void on_estimate(const fdi::EstimateEvent& event) override {
    if (event.warming_up) return;
    for (Series& s : series_) {
      if (s.estimator == event.estimator) add(s, event);
    }
  }
  void on_alarm(const fdi::Alarm& /*alarm*/) override {}

 private:
  static void add(Series& s, const fdi::EstimateEvent& event) {
    s.values.push_back(std::numeric_limits<double>::quiet_NaN());
    for (const fdi::NamedValue& value : event) {
      if (value.name != s.name || !event.valid) continue;
      s.values.back() = value.value;
      if (std::isfinite(value.std_error)) s.error_sum += value.std_error;
      ++s.valid;
    }
  }
  std::vector<Series>& series_;
};

/// The quantities asked for, or else those of bands without limits, or else of all bands.
std::vector<std::string> wanted_quantities(const Options& options,
                                           const fdi::PipelineConfig& pipeline) {
  if (!options.quantities.empty()) return options.quantities;
  std::vector<std::string> open;
  std::vector<std::string> all;
  for (const fdi::BandConfig& band : pipeline.bands) {
    if (fdi::split_quantity(band.quantity).source == fdi::kSampleSource) continue;
    all.push_back(band.quantity);
    if (std::isinf(band.low) && std::isinf(band.high)) open.push_back(band.quantity);
  }
  std::vector<std::string> found = open.empty() ? all : open;
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  if (found.empty()) {
    throw bad_config(options.config, "has no [[band]] on an estimator's quantity",
                     "one, or --quantity ESTIMATOR.b1");
  }
  return found;
}

std::vector<Series> make_series(const std::vector<std::string>& quantities,
                                const fdi::PipelineConfig& pipeline, const std::string& file) {
  std::vector<Series> series;
  for (const std::string& quantity : quantities) {
    const fdi::QuantityName name = fdi::split_quantity(quantity);
    std::size_t number = 0;
    while (number < pipeline.estimators.size() && pipeline.estimators[number].id != name.source) {
      ++number;
    }
    if (number == pipeline.estimators.size()) {
      throw bad_config(file, "'" + quantity + "' names no estimator", "ESTIMATOR.b1");
    }
    const fdi::EstimatorConfig& estimator = pipeline.estimators[number];
    const std::vector<std::string> names =
        fdi::estimate_names(estimator::parse_structure(estimator.structure, estimator.constant));
    if (std::find(names.begin(), names.end(), name.name) == names.end()) {
      std::string known;
      for (const std::string& each : names) known += (known.empty() ? "" : ", ") + each;
      throw bad_config(file, estimator.id + " estimates no '" + std::string(name.name) + "'",
                       known);
    }
    series.push_back({quantity, number, {}});
  }
  for (Series& s : series) s.name = fdi::split_quantity(s.quantity).name;
  return series;
}

fdi::LearnedBand learn(const Series& series, const fdi::EstimatorConfig& estimator,
                       const config::record::Record& record, const Options& options,
                       double period_s) {
  if (series.valid == 0) {
    throw config::schema::bad_data(record.name, "gives no valid estimate of " + series.quantity);
  }
  fdi::LearnConfig config;
  config.false_alarm_time_s = options.false_alarm_time_s;
  config.window_s = estimator.window_s;
  config.interval_s = estimator.method == "batch" ? estimator.window_s : estimator.stride_s;
  config.period_s = period_s;
  config.least_margin = series.error_sum / static_cast<double>(series.valid);
  fdi::LearnedLimits limits;
  try {
    limits = fdi::learn_limits(series.values, config);
  } catch (const config::schema::Error& error) {
    throw config::schema::bad_data(record.name, series.quantity + ": " + error.what());
  }
  constexpr double kHysteresisShare = 0.05;  // of the band
  fdi::LearnedBand band;
  band.quantity = series.quantity;
  band.structure = estimator.structure;
  band.estimator = estimator.fingerprint();
  band.low = limits.low;
  band.high = limits.high;
  band.hysteresis = kHysteresisShare * (limits.high - limits.low);
  band.centre = limits.centre;
  band.estimates = static_cast<std::int64_t>(series.valid);
  band.block_s = limits.block_s;
  return band;
}

void run(const Options& options) {
  fdi::PipelineConfig pipeline_config;
  config::schema::Document::load(options.config).read_part([&](config::schema::Visitor& v) {
    pipeline_config.visit(v);
  });
  std::vector<Series> series =
      make_series(wanted_quantities(options, pipeline_config), pipeline_config, options.config);
  pipeline_config.bands.clear();
  const config::record::Record record = config::record::read_record(options.record);
  for (const std::string& note : record.notes) {
    std::cerr << "spoolwatch: " << record.name << ": " << note << '\n';
  }
  fdi::Pipeline pipeline(pipeline_config, record.sample_time_s);
  Collector collector(series);
  for (const fdi::Sample& sample : to_samples(record)) pipeline.process(sample, collector);

  const double period_s = std::isnan(options.period_s)
                              ? fdi::find_period_s(record.u_V, record.sample_time_s)
                              : options.period_s;
  fdi::LearnedBands learned;
  learned.sample_time_s = record.sample_time_s;
  learned.source = options.record;
  learned.false_alarm_time_s = options.false_alarm_time_s;
  for (const Series& s : series) {
    learned.bands.push_back(
        learn(s, pipeline_config.estimators[s.estimator], record, options, period_s));
    const fdi::LearnedBand& band = learned.bands.back();
    std::cout << band.quantity << ": " << band.low << " to " << band.high << ", centre "
              << band.centre << ", from " << band.estimates << " estimates in blocks of "
              << band.block_s << " s\n";
  }
  config::record::write_whole(options.out,
                              config::schema::print_toml([&](auto& v) { learned.visit(v); }));
}

}  // namespace

void add_calibrate(CLI::App& command, int& /*exit_code*/) {
  auto options = std::make_shared<Options>();
  command.add_option("config", options->config, "configuration with [[estimator]] and [[band]]")
      ->required();
  command.add_option("record", options->record, "healthy record: CSV, MAT or LCM log")->required();
  command.add_option("-o,--output", options->out, "file for the learned bands")->required();
  command
      .add_option("--false-alarm-time-s", options->false_alarm_time_s,
                  "mean time between false alarms of each band")
      ->capture_default_str()
      ->check(positive_number());
  command.add_option("--quantity", options->quantities,
                     "ESTIMATOR.b1, ...; default: the bands without limits, else all bands");
  command
      .add_option("--period-s", options->period_s,
                  "period of the motion, 0 for none; default: found in the record")
      ->check(number_within(0.0, 1e6));
  command.callback([options] { run(*options); });
}

}  // namespace workbench
