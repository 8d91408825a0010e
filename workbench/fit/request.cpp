#include "workbench/fit/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "config/record/record.h"
#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/spelling.h"
#include "config/units/quantity.h"
#include "workbench/files/file_check.h"
#include "workbench/fit/ignored_spans.h"
#include "workbench/present/dataset_notes.h"
#include "workbench/present/printed_axis.h"

namespace workbench::fit {
namespace {

using config::schema::UsageError;
using greybox::Dataset;
using greybox::FitDataset;

/// A rod that moves less than this many noise floors does not determine a parameter.
constexpr double kLeastMotion = 5.0;

void check_files(const FitRequest& request) {
  files::check_records(request.records, request.holdouts,
                       "another record, or --fit to score on part of this one");
  files::InputFiles inputs{request.model, request.records};
  inputs.records.insert(inputs.records.end(), request.holdouts.begin(), request.holdouts.end());
  files::check_outputs(
      {{"--json", request.json}, {"--report", request.report}, {"-o", request.output, true}},
      inputs);
}

/// Datasets of `files` in order.
std::vector<Dataset> read(const std::vector<std::string>& files, const FitRequest& request,
                          std::vector<config::record::RecordUnits>& units) {
  std::vector<Dataset> records;
  for (const std::string& file : files) {
    const config::record::Record record = config::record::read_record(file, request.reading);
    units.push_back(config::record::units_of(record));
    records.push_back(greybox::dataset_of(record));
    records.back().name = file;
  }
  return records;
}

void require_motion(const FitDataset& data) {
  for (const Dataset& record : data.records) {
    const auto [low, high] = std::minmax_element(record.y_m.begin(), record.y_m.end());
    const double floor_m = std::isfinite(data.noise_floor_m) ? data.noise_floor_m : 0.0;
    if (*high - *low <= 2.0 * kLeastMotion * floor_m || !(*high > *low)) {
      throw config::schema::bad_data(
          record.name,
          fmt::format("the {} does not move: y stays within {:.3g} {} of itself",
                      config::units::moving_part(), 1e6 * (*high - *low),
                      config::units::axis_unit("um")),
          "a record with motion well above the position's noise");
    }
  }
}

void note_saturation(const Dataset& record, std::vector<std::string>& notes) {
  const auto [low, high] = std::minmax_element(record.u_V.begin(), record.u_V.end());
  const double most_V = std::max(std::abs(*low), std::abs(*high));
  const auto limited = std::count_if(record.u_V.begin(), record.u_V.end(), [&](double u_V) {
    return std::abs(u_V) >= most_V * (1.0 - 1e-9);
  });
  const double share = static_cast<double>(limited) / static_cast<double>(record.size());
  if (!(*high > *low)) {
    notes.push_back(record.name + ": the command never changes");
  } else if (share > 0.2) {
    notes.push_back(fmt::format("{}: the command stands at its limit for {:.0f} % of the time",
                                record.name, 100.0 * share));
  }
}

void weigh(const FitRequest& request, greybox::EstimationProblem& problem) {
  FitDataset& data = problem.data;
  if (!request.weights.empty() && request.weights.size() != request.records.size()) {
    throw UsageError("--weight: has " + std::to_string(request.weights.size()) +
                     " numbers; allowed: one for each of the " +
                     std::to_string(request.records.size()) + " records");
  }
  Eigen::VectorXd mask = Eigen::VectorXd::Ones(data.size());
  std::vector<RecordTimes> times;
  for (const Dataset& record : data.records) times.push_back({record.name, &record.t_s});
  for_ignored(request.ignored, times, [&](std::size_t record, std::size_t sample) {
    mask[static_cast<Eigen::Index>(data.starts[record] + sample)] = 0.0;
  });
  if (request.fit == "all" && request.holdouts.empty()) {
    data.training_mask = data.all_mask;
    data.validation_mask.setZero();
  }
  data.training_mask = data.training_mask.cwiseProduct(mask);
  data.validation_mask = data.validation_mask.cwiseProduct(mask);
  data.all_mask = data.all_mask.cwiseProduct(mask);
  problem.weights = data.training_mask;
  for (std::size_t r = 0; r < request.weights.size(); ++r) {
    const auto size = static_cast<Eigen::Index>(data.records[r].size());
    problem.weights.segment(static_cast<Eigen::Index>(data.starts[r]), size) *= request.weights[r];
  }
  const auto least = static_cast<double>(10 * problem.parameters.size());
  if ((problem.weights.array() > 0.0).cast<double>().sum() < least) {
    throw UsageError(
        "--ignore, --weight, --fit: leave fewer than 10 samples for each "
        "of the " +
        std::to_string(problem.parameters.size()) + " parameters");
  }
}

void choose_profiles(const FitRequest& request, const greybox::EstimationProblem& problem,
                     greybox::EstimationOptions& options) {
  for (const std::string& name : request.profiles) {
    if (name == "none") options.profiling = greybox::Profiling::none;
    if (name == "none" || name == "doubtful") continue;
    std::vector<std::string> names;
    for (const auto& p : problem.parameters) names.push_back(p.name);
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      std::string allowed = "none, doubtful";
      for (const std::string& known : names) allowed += ", " + known;
      const std::string near = config::schema::nearest(name, names);
      throw config::schema::bad_config(
          "--profile " + name,
          "is not fitted" + (near.empty() ? std::string() : ", did you mean " + near + "?"),
          allowed);
    }
    options.profiling = greybox::Profiling::named;
    options.profiled.push_back(name);
  }
}

std::string precise(double value) { return fmt::format("{:.9g}", value); }

}  // namespace

PreparedFit prepare(const FitRequest& request) {
  PreparedFit out;
  out.begin = std::chrono::steady_clock::now();
  check_files(request);
  greybox::EstimationProblem& problem = out.problem;
  greybox::EstimationOptions& options = out.options;
  problem.model = plant_sim::load_model(request.model, request.assignments);
  const present::PrintedAxis axis(present::motion_of(problem.model));
  FreeParameters choice = select_parameters(problem.model, request.selection);
  problem.parameters = choice.parameters;
  choose_profiles(request, problem, options);
  std::vector<config::record::RecordUnits> units;
  std::vector<Dataset> records = read(request.records, request, units);
  std::vector<Dataset> holdouts = read(request.holdouts, request, units);
  config::record::require_same_units(units);
  const greybox::Split split =
      request.fit == "all" ? greybox::Split::blocks : greybox::parse_split(request.fit);
  problem.data = greybox::fit_dataset(std::move(records), std::move(holdouts), split);
  require_motion(problem.data);
  start_neutral_effects(problem.model, problem.data, choice);
  problem.start = choice.start;
  for (Dataset& record : problem.data.records) present::note_against_model(problem.model, record);
  out.notes = present::notes_of(problem.data.records);
  for (const Dataset& record : problem.data.records) {
    note_saturation(record, out.notes);
    if (request.observer_per_s * record.sample_time_s >= 1.0) {
      throw UsageError("--observer: is too fast for samples every " +
                       precise(record.sample_time_s) + " s; allowed: below 1 / sample time");
    }
  }
  out.noise_floor_m = problem.data.noise_floor_m;
  if (!std::isfinite(out.noise_floor_m)) problem.data.noise_floor_m = 0.0;
  weigh(request, problem);
  options.starts = request.starts;
  options.observer_per_s = request.observer_per_s;
  options.threads =
      request.threads > 0 ? request.threads : std::max(1U, std::thread::hardware_concurrency());
  out.command = request.command;
  out.output = request.output;
  return out;
}

}  // namespace workbench::fit
