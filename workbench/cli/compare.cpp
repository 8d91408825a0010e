// `spoolwatch compare MODEL.toml RECORD`: where a model fails against a measurement, as text, JSON
// and a report.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "config/messages/channels.h"
#include "config/record/record.h"
#include "config/schema/error.h"
#include "estimator/greybox/trajectory.h"
#include "estimator/greybox/validation/comparison.h"
#include "plant_sim/model_file.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/cli/interrupt.h"
#include "workbench/cli/number_check.h"
#include "workbench/cli/selection_options.h"
#include "workbench/compare/comparison_report.h"
#include "workbench/compare/request.h"
#include "workbench/exchange/export.h"
#include "workbench/files/file_check.h"
#include "workbench/files/write_all.h"
#include "workbench/live/live_compare.h"
#include "workbench/present/json.h"
#include "workbench/present/printed_axis.h"

namespace workbench::cli {

namespace greybox = estimator::greybox;
namespace validation = estimator::greybox::validation;
namespace {

using config::schema::UsageError;

struct CompareArguments {
  compare::CompareRequest request;
  std::string json;
  std::string report;
  std::string residuals;
  bool all = false;
  std::string command;
  bool live = false;
  double duration_s = 0.0;  ///< duration of --live; 0: until a signal
  live::LiveCompareOptions watch{config::messages::kDefaultUrl, config::messages::kDefaultPrefix};
};

bool utf8_terminal() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* const value = std::getenv(name);
    if (value == nullptr || *value == '\0') continue;
    const std::string locale = value;
    return locale.find("UTF-8") != std::string::npos || locale.find("utf8") != std::string::npos;
  }
  return false;
}

/// Command, positions and states of every sample, as a record that reads back.
void write_residuals(const validation::Comparison& comparison, const plant_sim::ModelFile& model,
                     const config::record::RecordUnits& units, const CompareArguments& a) {
  const greybox::Dataset& data = comparison.record;
  config::record::Record out;
  out.name = a.residuals;
  out.sample_time_s = data.sample_time_s;
  out.t_s = data.t_s;
  out.u_V = data.u_V;
  out.y_m = data.y_m;
  out.command_unit = units.command;
  out.position_unit = units.position;
  const auto add = [&out](const std::string& name) -> std::vector<double>& {
    out.further.emplace_back(name, std::vector<double>{});
    return out.further.back().second;
  };
  greybox::Trajectory free = greybox::trajectory_of(model, data);
  add("free_run_" + units.position) = std::move(free.reading_m);
  std::vector<double>& corrected_m = add("drift_corrected_" + units.position);
  for (std::size_t k = 0; k < data.size(); ++k) {
    corrected_m.push_back(data.y_m[k] - comparison.error_m[k]);
  }
  add("free_run_residual_" + units.position) = comparison.free_error_m;
  add("residual_" + units.position) = comparison.error_m;
  add("settled").assign(data.valid.begin(), data.valid.end());
  for (auto& [name, values] : free.states) add("state_" + name) = std::move(values);
  exchange::write_record_file(out, a.residuals, "--residuals");
}

void run_live(CompareArguments& a) {
  for (const auto& [given, option] :
       {std::pair(!a.request.record.empty(), "RECORD"), std::pair(!a.report.empty(), "--report"),
        std::pair(a.all, "--all"), std::pair(!a.residuals.empty(), "--residuals"),
        std::pair(!a.request.ignored.empty(), "--ignore"),
        std::pair(a.request.reading.given(), "--map, --resample, --flip or --advance"),
        std::pair(!a.json.empty() && a.json != "-", "--json FILE")}) {
    if (given) throw UsageError(std::string("--live: not together with ") + option);
  }
  a.watch.json = a.json == "-";
  a.watch.observer_per_s = a.request.observer_per_s;
  const StopCondition stop(a.duration_s);
  a.watch.ended = [&stop] { return stop.reached(); };
  a.watch.interrupted = StopCondition::asked;
  live::watch(plant_sim::load_model(a.request.model, a.request.assignments), a.watch);
}

void run(CompareArguments& a) {
  if (a.live) return run_live(a);
  if (a.request.record.empty()) throw UsageError("compare: no RECORD, and not --live");
  files::check_outputs({{"--json", a.json}, {"--report", a.report}, {"--residuals", a.residuals}},
                       {a.request.model, {a.request.record}});
  const compare::PreparedComparison prepared = compare::prepare(a.request);
  const present::PrintedAxis axis(present::motion_of(prepared.model));
  const validation::Comparison comparison =
      validation::compare(prepared.model, prepared.record, a.request.observer_per_s);
  const compare::DisturbanceCheck check = compare::check_disturbance(
      prepared.model, comparison, std::max(1U, std::thread::hardware_concurrency()));
  files::write_all({[&] {
                      if (!a.residuals.empty())
                        write_residuals(comparison, prepared.model, prepared.units, a);
                    },
                    [&] {
                      if (a.report.empty()) return;
                      present::write_report(compare::make_report(comparison, a.command, check),
                                            a.report);
                    },
                    [&] {
                      if (present::write_json(compare::to_json(comparison, check), a.json)) return;
                      std::cout << compare::to_text(comparison, utf8_terminal(), a.all, check);
                    }});
}

}  // namespace

void add_compare(CLI::App& command, int& /*exit_code*/) {
  auto arguments = std::make_shared<CompareArguments>();
  add_model(command, arguments->request.model);
  add_record(command, arguments->request.record)->required(false);
  add_reading(command, arguments->request.reading);
  add_json(command, arguments->json);
  add_report(command, arguments->report);
  command.add_option("--from", arguments->request.from_s, "s: ignore samples before this time")
      ->check(finite_number());
  command.add_option("--to", arguments->request.to_s, "s: ignore samples after this time")
      ->check(finite_number());
  add_ignored(command, arguments->request.ignored);
  command.add_option("--residuals", arguments->residuals,
                     "file for every sample: command, position, free run, drift-corrected run, "
                     "residuals, states of the free run (.csv, .mat, .h5)");
  add_observer(command, arguments->request.observer_per_s)->check(positive_number());
  add_set(command, arguments->request.assignments);
  command.add_flag("--all", arguments->all,
                   "the error by every variable, not only the most significant");
  CLI::Option* live = command.add_flag("--live", arguments->live,
                                       "compare with the running daemon, one line per second");
  command
      .add_option("--lcm-url", arguments->watch.url,
                  "LCM URL of --live; file:///LOG?mode=r reads a log")
      ->needs(live)
      ->capture_default_str();
  command.add_option("--prefix", arguments->watch.prefix, "prefix of the channel names of --live")
      ->needs(live)
      ->capture_default_str();
  command
      .add_option("--duration", arguments->duration_s, "run time of --live, s (0: until Ctrl-C)")
      ->needs(live)
      ->check(CLI::NonNegativeNumber);
  command.callback([arguments, &command] {
    arguments->command = command_line("compare", command);
    run(*arguments);
  });
}

}  // namespace workbench::cli
