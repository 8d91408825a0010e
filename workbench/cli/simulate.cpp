// `spoolwatch simulate`: a record from a model file, in closed loop or by a recorded command.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "config/record/record.h"
#include "config/schema/document.h"
#include "config/schema/error.h"
#include "estimator/greybox/trajectory.h"
#include "plant_sim/model_file.h"
#include "plant_sim/plant.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/cli/number_check.h"
#include "workbench/exchange/export.h"
#include "workbench/files/file_check.h"
#include "workbench/present/printed_axis.h"
#include "workbench/simulate/closed_loop.h"
#include "workbench/simulate/fault_text.h"
#include "workbench/simulate/late_changes.h"
#include "workbench/simulate/transducers.h"

namespace workbench::cli {
namespace {

namespace fs = std::filesystem;
namespace greybox = estimator::greybox;
using config::schema::ConfigError;
using config::schema::RunError;
using config::schema::UsageError;

/// Samples between two looks at the progress line: ten minutes of the stand.
constexpr std::int64_t kProgressEvery = 120'000;

struct SimulateArguments {
  std::string model;
  std::string output;
  std::string reference;
  std::string command;
  config::record::ReadOptions reading;
  double duration_s = 60.0;
  std::uint64_t seed = 1;
  bool pressures = false;
  double pressure_noise_Pa = NAN;  ///< NaN: the instruments' own
  std::vector<std::string> assignments;
  std::vector<std::string> faults;
};

/// --reference names a kind, or else a file.
void choose_reference(const std::string& text, config::schema::Document& document) {
  if (text.empty()) return;
  for (const char* kind : {"sine", "triangle", "multisine", "steps", "chirp", "prbs"}) {
    if (text == kind) {
      document.set("reference.kind=\"" + text + "\"");
      return;
    }
  }
  std::error_code ignored;
  if (!fs::is_regular_file(text, ignored)) {
    throw UsageError("--reference " + text +
                     ": is no kind and no file; allowed: sine, triangle, multisine, steps, "
                     "chirp, prbs, or a CSV file with t_s,reference_m");
  }
  document.set("reference.kind=\"file\"");
  document.set("reference.file='" + fs::absolute(text).string() + "'");
}

simulate::Scenario read_scenario(const SimulateArguments& arguments) {
  auto document = config::schema::Document::load(arguments.model);
  choose_reference(arguments.reference, document);
  for (const std::string& assignment : arguments.assignments) document.set(assignment);
  simulate::Scenario scenario = simulate::read_scenario(document);
  for (const std::string& fault : arguments.faults) {
    scenario.faults.push_back(simulate::parse_fault(fault));
  }
  return scenario;
}

/// Before an hour is simulated for nothing.
void check_output(const std::string& output) {
  const fs::path folder = fs::absolute(output).parent_path();
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    throw RunError(output + ": the folder " + folder.string() + " does not exist");
  }
}

/// The columns beside t_s,u_V,y_m.
std::vector<const char*> column_names(const SimulateArguments& arguments) {
  std::vector<const char*> names{"reference_m", "u_requested_V", "saturated"};
  if (arguments.pressures) {
    names.insert(names.end(), {"supply_pressure_Pa", "pressure_in_Pa", "pressure_out_Pa"});
  }
  return names;
}

/// Their values in that order.
std::vector<double> further_of(const simulate::LoopRow& row,
                               std::optional<simulate::SimulatedTransducers>& transducers) {
  std::vector<double> values{row.reference_m, row.u_requested_V, row.saturated ? 1.0 : 0.0};
  if (!transducers) return values;
  const config::signals::Pressures read = transducers->read(row.pressures);
  values.insert(values.end(), {read.supply_Pa, read.in_Pa, read.out_Pa});
  return values;
}

config::record::Record simulate_record(const SimulateArguments& arguments,
                                       const simulate::Scenario& scenario) {
  simulate::ClosedLoop loop(scenario, arguments.seed);
  std::optional<simulate::SimulatedTransducers> transducers;
  if (arguments.pressures) transducers.emplace(scenario.instruments, arguments.seed);
  const auto samples = std::llround(arguments.duration_s / simulate::kSampleTime_s);
  const bool show = isatty(STDERR_FILENO) == 1;
  config::record::Record record;
  record.name = arguments.output;
  record.sample_time_s = simulate::kSampleTime_s;
  for (auto* column : {&record.t_s, &record.u_V, &record.y_m}) {
    column->reserve(static_cast<std::size_t>(samples));
  }
  for (const char* name : column_names(arguments)) {
    record.further.emplace_back(name, std::vector<double>{});
    record.further.back().second.reserve(static_cast<std::size_t>(samples));
  }
  for (std::int64_t k = 0; k < samples; ++k) {
    const simulate::LoopRow row = loop.step();
    record.t_s.push_back(row.t_s);
    record.u_V.push_back(row.u_applied_V);
    record.y_m.push_back(row.y_m);
    std::size_t column = 0;
    for (const double value : further_of(row, transducers)) {
      record.further[column++].second.push_back(value);
    }
    if (show && k % kProgressEvery == kProgressEvery - 1) {
      std::cerr << "\rsimulate: " << row.t_s << " of " << arguments.duration_s << " s"
                << (k + kProgressEvery >= samples ? "\n" : "") << std::flush;
    }
  }
  return record;
}

void say_late_changes(const std::string& model, const std::vector<plant_sim::Change>& changes,
                      double end_s) {
  for (const std::string& late : simulate::late_changes(changes, end_s)) {
    std::cerr << "spoolwatch: " << model << ": " << late << '\n';
  }
}

/// The plant driven by the command of a record; its own controller and instruments have no part.
config::record::Record simulate_command(const SimulateArguments& a) {
  const plant_sim::ModelFile model = plant_sim::load_model(a.model, a.assignments);
  const present::PrintedAxis axis(present::motion_of(model));
  config::record::ReadOptions reading = a.reading;
  reading.position_optional = true;
  const config::record::Record given = config::record::read_record(a.command, reading);
  for (const std::string& note : given.notes) {
    std::cerr << "spoolwatch: " << given.name << ": " << note << '\n';
  }
  if (!given.has_position && !given.gaps.empty()) {
    throw config::schema::bad_data(given.name,
                                   "has " + std::to_string(given.gaps.size()) +
                                       " gaps, the first at " +
                                       std::to_string(given.t_s[given.gaps.front()]) +
                                       " s: the position behind a gap is not known",
                                   "a command without gaps, or with the measured position");
  }
  greybox::Dataset data;
  data.name = given.name;
  data.sample_time_s = given.sample_time_s;
  data.t_s = given.t_s;
  data.u_V = given.u_V;
  data.y_m = given.y_m;
  if (!given.has_position) {
    data.y_m.assign(given.size(),
                    plant_sim::make_plant(plant_sim::without_changes(model))->reading_m());
  }
  say_late_changes(a.model, model.changes, given.t_s.back());
  data.starts = {0};
  data.starts.insert(data.starts.end(), given.gaps.begin(), given.gaps.end());
  greybox::Trajectory run = greybox::trajectory_of(model, data);
  config::record::Record out;
  out.name = a.output;
  out.sample_time_s = given.sample_time_s;
  out.command_unit = given.command_unit;
  out.position_unit = given.position_unit;
  out.t_s = given.t_s;
  out.u_V = given.u_V;
  out.y_m = std::move(run.reading_m);
  if (given.has_position) out.further.emplace_back("measured_" + given.position_unit, given.y_m);
  for (auto& [name, values] : run.states) {
    out.further.emplace_back("state_" + name, std::move(values));
  }
  return out;
}

/// The closed loop's own options say nothing about a recorded command.
void check_command(const SimulateArguments& a, const CLI::App& command) {
  for (const char* option :
       {"--duration", "--seed", "--reference", "--pressures", "--pressure-noise", "--fault"}) {
    if (command.count(option) > 0) {
      throw UsageError(std::string("--command: not together with ") + option);
    }
  }
  files::check_outputs({{"-o", a.output}}, {a.model, {a.command}});
}

void check_pressures(const SimulateArguments& arguments, const simulate::Scenario& scenario) {
  if (!arguments.pressures) {
    if (!std::isnan(arguments.pressure_noise_Pa)) {
      throw UsageError("--pressure-noise: needs --pressures");
    }
    return;
  }
  if (std::isfinite(
          plant_sim::make_plant(plant_sim::without_changes(scenario.model))->pressures().in_Pa))
    return;
  throw ConfigError(arguments.model + ": --pressures: plant " + scenario.model.plant +
                    " has none; allowed: hydraulic_actuator, hydraulic_cylinder");
}

}  // namespace

void add_simulate(CLI::App& command, int& /*exit_code*/) {
  auto arguments = std::make_shared<SimulateArguments>();
  add_model(command, arguments->model);
  command
      .add_option(
          "-o,--output", arguments->output,
          "CSV: t_s,u_V,y_m,reference_m,u_requested_V,saturated, and pressures if asked for")
      ->required();
  command.add_option("--duration", arguments->duration_s, "seconds to simulate")
      ->check(number_within(simulate::kSampleTime_s, 1e6))
      ->capture_default_str();
  command
      .add_option("--seed", arguments->seed,
                  "seed of the noise; the same seed gives the same bytes")
      ->check(number_within(0.0, 1e18))
      ->capture_default_str();
  command.add_option(
      "--reference", arguments->reference,
      "sine, triangle, multisine, steps, chirp, prbs, or a CSV file with t_s,reference_m");
  command.add_option("--command", arguments->command,
                     "RECORD whose command drives the plant in open loop, at its rate and from "
                     "its first position; -o also as .mat or .h5, with the states");
  add_reading(command, arguments->reading);
  command.add_flag("--pressures", arguments->pressures,
                   "columns supply_pressure_Pa, pressure_in_Pa, pressure_out_Pa as well");
  command
      .add_option("--pressure-noise", arguments->pressure_noise_Pa,
                  "Pa: standard deviation of each one's noise, for instruments.pressure_noise_Pa")
      ->check(number_within(0.0, 1e9));
  command
      .add_option("--set", arguments->assignments,
                  "table.key=value of the model file, [reference] or [instruments]")
      ->allow_extra_args(false);
  command
      .add_option("--fault", arguments->faults,
                  "PARAMETER=VALUE@SECONDS or PARAMETER*FACTOR@SECONDS, +SECONDS for a ramp")
      ->allow_extra_args(false);
  command.callback([arguments, &command] {
    if (!arguments->command.empty()) {
      check_command(*arguments, command);
      exchange::write_record_file(simulate_command(*arguments), arguments->output, "-o");
      return;
    }
    if (arguments->reading.given()) {
      throw UsageError("--map, --resample, --flip, --advance: need --command");
    }
    simulate::Scenario scenario = read_scenario(*arguments);
    const present::PrintedAxis axis(present::motion_of(scenario.model));
    if (!std::isnan(arguments->pressure_noise_Pa)) {
      scenario.instruments.pressure_noise_Pa = arguments->pressure_noise_Pa;
    }
    check_pressures(*arguments, scenario);
    check_output(arguments->output);
    say_late_changes(arguments->model, scenario.model.changes, arguments->duration_s);
    say_late_changes(arguments->model, scenario.faults, arguments->duration_s);
    write_csv(simulate_record(*arguments, scenario), arguments->output);
  });
}

}  // namespace workbench::cli
