// `spoolwatch calibrate CONFIG.toml RECORD -o bands.toml`: alarm bands learned from a healthy
// record, with the configuration's own estimators. The method: estimator/fdi/learn.h.
#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>

#include "config/record/record.h"
#include "config/record/whole_file.h"
#include "config/schema/document.h"
#include "estimator/fdi/learned_bands.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/cli/number_check.h"
#include "workbench/train/learn_bands.h"

namespace workbench::cli {
namespace {

namespace fdi = estimator::fdi;

constexpr double kWorthSaying = 1.1;

struct CalibrateOptions {
  std::string config;
  std::string record;
  config::record::ReadOptions reading;
  std::string out;
  std::vector<std::string> quantities;
  double false_alarm_time_s = 86400.0;
  double period_s = std::numeric_limits<double>::quiet_NaN();
};

void run(const CalibrateOptions& options) {
  fdi::PipelineConfig pipeline_config;
  config::schema::Document::load(options.config).read_part([&](config::schema::Visitor& v) {
    pipeline_config.visit(v);
  });
  const std::vector<std::string> quantities =
      options.quantities.empty() ? train::wanted_quantities(pipeline_config, options.config)
                                 : options.quantities;
  const config::record::Record record =
      config::record::read_record(options.record, options.reading);
  config::record::require_volts_and_metres(record);
  for (const std::string& note : record.notes) {
    std::cerr << "spoolwatch: " << record.name << ": " << note << '\n';
  }
  fdi::LearnedBands learned =
      train::learn_bands(pipeline_config, quantities, {&record, 1},
                         {options.config, options.false_alarm_time_s, options.period_s});
  for (const fdi::LearnedBand& band : learned.bands) {
    std::cout << band.quantity << ": " << band.low << " to " << band.high << ", centre "
              << band.centre << ", from " << band.estimates << " estimates in blocks of "
              << band.block_s << " s";
    if (band.widening_ratio > kWorthSaying) {
      std::cout << "; wider by " << std::lround(100.0 * (band.widening_ratio - 1.0))
                << " % because they are few: " << std::ceil(band.enough_s)
                << " s of healthy motion make that less than 10 %";
    }
    std::cout << '\n';
  }
  config::record::write_whole(options.out,
                              config::schema::print_toml([&](auto& v) { learned.visit(v); }));
}

}  // namespace

void add_calibrate(CLI::App& command, int& /*exit_code*/) {
  auto options = std::make_shared<CalibrateOptions>();
  command.add_option("config", options->config, "configuration with [[estimator]] and [[band]]")
      ->required();
  add_record(command, options->record);
  add_reading(command, options->reading);
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
  command.alias("learn-bands");
  command.callback([options] { run(*options); });
}

}  // namespace workbench::cli
