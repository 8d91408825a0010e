// spoolwatch backtest NEW.toml LOG...: new rules on old logs.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>

#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/cli/number_check.h"
#include "workbench/present/json.h"
#include "workbench/replay/backtest_report.h"

namespace workbench::cli {
namespace {

struct BacktestOptions {
  std::string configuration;
  std::vector<std::string> logs;
  config::record::ReadOptions reading;
  std::string old;
  std::string json;
  double tolerance_s = 10.0;
};

void run(const BacktestOptions& options) {
  const replay::BacktestRules new_rules = replay::read_rules(options.configuration);
  std::optional<replay::BacktestRules> old_rules;
  if (!options.old.empty()) old_rules = replay::read_rules(options.old);
  replay::BacktestReport report;
  report.new_rules = options.configuration;
  report.old_rules = options.old;
  report.runs = replay::run_backtest(new_rules, old_rules, options.logs, options.reading);
  for (const replay::BacktestRun& each : report.runs) {
    report.differences.push_back(
        replay::compare(each.before, each.after, options.tolerance_s, 0.5 * each.sample_time_s));
  }
  if (!present::write_json(replay::backtest_json(report).dump(2) + '\n', options.json)) {
    replay::print_backtest(report, std::cout);
  }
}

}  // namespace

void add_backtest(CLI::App& command, int& /*exit_code*/) {
  const auto options = std::make_shared<BacktestOptions>();
  command
      .add_option("configuration", options->configuration,
                  "the new [[estimator]], [[band]] and bands_file")
      ->required();
  command.add_option("logs", options->logs, "LCM event logs, folders of them, or records")
      ->required();
  command.add_option("--old", options->old,
                     "compare with what this configuration tells, not with what was recorded");
  command
      .add_option("--tolerance", options->tolerance_s,
                  "alarms that come so near, or overlap, are the same one, s")
      ->capture_default_str()
      ->check(number_within(0.0, 1e6));
  add_reading(command, options->reading);
  add_json(command, options->json);
  command.callback([options] { run(*options); });
}

}  // namespace workbench::cli
