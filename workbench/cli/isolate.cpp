// spoolwatch isolate: physical parameters per window, and the changes named.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/cli/number_check.h"
#include "workbench/files/write_all.h"
#include "workbench/isolate/isolation.h"
#include "workbench/present/json.h"

namespace workbench::cli {
namespace {

using isolate::IsolationReport;
using isolate::IsolationRequest;

void run(const IsolationRequest& request) {
  const IsolationReport outcome = isolate::isolate(request);
  const config::units::PrintedAxis axis(outcome.motion);
  files::write_all({[&] {
                      if (!request.report.empty()) write_report(to_report(outcome), request.report);
                    },
                    [&] {
                      if (present::write_json(to_json(outcome), request.json)) return;
                      std::cout << to_text(outcome, request.all_windows);
                    }});
}

void declare_judging(CLI::App& command, IsolationRequest& request) {
  CLI::Option* const baseline =
      command.add_option("--healthy", request.baseline, "from:to, s: the part without a fault")
          ->capture_default_str();
  CLI::Option* const apart =
      command
          .add_option("--healthy-record", request.healthy_record,
                      "a record without a fault, of the same rig and sample time")
          ->excludes(baseline);
  command
      .add_option("--healthy-rms", request.baseline_rms_m,
                  "m: the healthy error, instead of learning it; the file's values are healthy")
      ->check(positive_number())
      ->excludes(baseline)
      ->excludes(apart);
  command
      .add_option("--limit", request.settings.most_ratio,
                  "times the healthy error: windows beyond are invalid")
      ->check(number_within(1.0, 1e3))
      ->capture_default_str();
  command
      .add_option("--least", request.settings.thresholds.least_ratio,
                  "ratio: smaller changes of a parameter are not named")
      ->check(number_within(1e-4, 1.0))
      ->capture_default_str();
  command.add_flag("--suspect-position-sensor", request.settings.thresholds.suspect_position_sensor,
                   "its scale or drift may explain a change as well");
  auto& following = request.settings.drift;
  CLI::Option* const follow =
      command
          .add_option("--follow", following.parameters,
                      "name[,name...]: parameters whose slow changes are no faults")
          ->delimiter(',')
          ->allow_extra_args(false);
  command
      .add_option("--follow-per-hour", following.ratio_per_h,
                  "ratio per hour: fastest slow change that the healthy value follows")
      ->check(number_within(1e-3, 1e3))
      ->needs(follow)
      ->capture_default_str();
}

}  // namespace

void add_isolate(CLI::App& command, int& /*exit_code*/) {
  auto request = std::make_shared<IsolationRequest>();
  add_model(command, request->model);
  add_record(command, request->record);
  add_reading(command, request->reading);
  command
      .add_option("--parameters", request->parameters,
                  "name[,name...] as in model files, such as null_bias.offset_V, mass_kg")
      ->allow_extra_args(false)
      ->capture_default_str();
  command.add_option("--window", request->settings.window_s, "s: length of a window")
      ->check(number_within(0.1, 1e3))
      ->capture_default_str();
  command.add_option("--stride", request->settings.stride_s, "s: time between windows")
      ->check(number_within(1e-3, 1e3))
      ->capture_default_str();
  add_observer(command, request->settings.observer_per_s)->check(number_within(0.0, 1e3));
  declare_judging(command, *request);
  command.add_flag("--no-pressures", request->no_pressures,
                   "supply_pressure_Pa, pressure_in_Pa, pressure_out_Pa of RECORD are not used");
  add_set(command, request->assignments);
  command.add_option("--learn", request->learn_baseline,
                     "file for the healthy values, to be named by [[tracker]] healthy");
  command.add_option("--rig", request->rig_id, "rig id stored in that file; other rigs reject it");
  command.add_flag("--windows", request->all_windows, "print every window");
  add_json(command, request->json);
  add_report(command, request->report);
  command.alias("track");
  command.callback([request, &command] {
    request->command = command_line("isolate", command);
    run(*request);
  });
}

}  // namespace workbench::cli
