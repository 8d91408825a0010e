#include "workbench/isolate/isolation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>

#include "config/record/record.h"
#include "config/record/whole_file.h"
#include "config/schema/document.h"
#include "config/schema/error.h"
#include "estimator/fdi/tracker/baseline_file.h"
#include "estimator/fdi/tracker/tracking_text.h"
#include "estimator/greybox/dataset.h"
#include "estimator/greybox/parameter_catalogue.h"
#include "estimator/greybox/tracking/disturbed_baseline.h"
#include "estimator/residual/noise_floor.h"
#include "plant_sim/hydraulics.h"
#include "workbench/files/file_check.h"
#include "workbench/fit/parameter_selection.h"
#include "workbench/present/printed_axis.h"

namespace workbench::isolate {

namespace tracker = estimator::fdi::tracker;
namespace greybox = estimator::greybox;
namespace {

using config::record::Record;
using config::schema::UsageError;

/// A healthy error above this number of noise floors, and a healthy value so far off the file's,
/// are worth a note.
constexpr double kUncalibrated = 1.5;
constexpr double kOffFile = 0.03;
constexpr double kLeastSamples = 20.0;
constexpr const char* kSupply = "supply_pressure_Pa";
constexpr const char* kIn = "pressure_in_Pa";
constexpr const char* kOut = "pressure_out_Pa";

struct TimeSpan {
  double from_s = 0.0;
  double to_s = 0.0;
};

TimeSpan span(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon != std::string::npos) {
    const TimeSpan out{fit::number_in(text.substr(0, colon)),
                       fit::number_in(text.substr(colon + 1))};
    if (out.from_s < out.to_s) return out;
  }
  throw UsageError("--healthy " + text + ": is not a span; allowed: from:to, in s");
}

/// Null: the record has none of that name.
const std::vector<double>* column(const Record& record, std::string_view name) {
  for (const auto& [its_name, values] : record.further) {
    if (its_name == name) return &values;
  }
  return nullptr;
}

/// The record's pressures; null: not there, or not to be used.
struct Readings {
  const std::vector<double>* supply_Pa = nullptr;
  const std::vector<double>* in_Pa = nullptr;  ///< as the next: both or none
  const std::vector<double>* out_Pa = nullptr;

  /// Has at least what `other` has.
  [[nodiscard]] bool covers(const Readings& other) const {
    return (other.supply_Pa == nullptr || supply_Pa != nullptr) &&
           (other.in_Pa == nullptr || in_Pa != nullptr);
  }
  [[nodiscard]] config::signals::Pressures at(std::size_t k) const {
    config::signals::Pressures out;
    if (supply_Pa != nullptr) out.supply_Pa = (*supply_Pa)[k];
    if (in_Pa != nullptr) out.in_Pa = (*in_Pa)[k];
    if (out_Pa != nullptr) out.out_Pa = (*out_Pa)[k];
    return out;
  }
};

bool mostly_read(const std::vector<double>* column) {
  return column != nullptr &&
         2 * std::count_if(column->begin(), column->end(),
                           [](double value) { return std::isfinite(value); }) >=
             static_cast<std::ptrdiff_t>(column->size());
}

Readings readings_of(const Record& record, const IsolationRequest& request) {
  Readings out;
  if (request.no_pressures) return out;
  out.supply_Pa = column(record, kSupply);
  // The errors of the healthy chambers are estimated here.
  if (request.baseline_rms_m > 0.0) return out;
  if (!mostly_read(column(record, kIn)) || !mostly_read(column(record, kOut))) return out;
  out.in_Pa = column(record, kIn);
  out.out_Pa = column(record, kOut);
  return out;
}

/// With a reading of the supply pressure or of both chambers' the valve gain is identifiable, and
/// is tracked as well.
std::vector<std::string> tracked_names(const plant_sim::ModelFile& model,
                                       const IsolationRequest& request, const Readings& readings,
                                       std::vector<std::string>& notes) {
  std::vector<std::string> names = greybox::split_names(request.parameters);
  const auto has = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const bool supply = readings.supply_Pa != nullptr && has(kSupply);
  if (supply) {
    notes.push_back(std::string("the record's ") + kSupply + " takes the place of its fit");
  }
  if (readings.in_Pa != nullptr) {
    notes.push_back(std::string("the record's ") + kIn + " and " + kOut +
                    " are fitted beside the position");
  }
  if ((supply || readings.in_Pa != nullptr) && has(kSupply)) {
    const auto oil = plant_sim::hydraulics_of(model);
    if (oil && !has(oil->gain_parameter.c_str())) names.push_back(oil->gain_parameter);
  }
  return names;
}

/// [from, to) of the record.
Record cut(const Record& record, const TimeSpan& within) {
  Record out;
  out.name = record.name;
  out.sample_time_s = record.sample_time_s;
  out.notes = record.notes;
  std::size_t gap = 0;
  for (std::size_t k = 0; k < record.size(); ++k) {
    const bool after_gap = gap < record.gaps.size() && record.gaps[gap] == k;
    if (after_gap) ++gap;
    if (record.t_s[k] < within.from_s || record.t_s[k] >= within.to_s) continue;
    if (after_gap && out.size() > 0) out.gaps.push_back(out.size());
    out.t_s.push_back(record.t_s[k]);
    out.u_V.push_back(record.u_V[k]);
    out.y_m.push_back(record.y_m[k]);
  }
  return out;
}

/// Every window of [from, to) of the record.
std::vector<WindowResult> track(ParameterTracker& tracker, const Record& record,
                                const Readings& readings, const TimeSpan& within) {
  std::vector<WindowResult> windows;
  std::size_t gap = 0;
  bool first = true;
  for (std::size_t k = 0; k < record.size(); ++k) {
    if (gap < record.gaps.size() && record.gaps[gap] == k) {
      first = true;
      ++gap;
    }
    if (record.t_s[k] < within.from_s || record.t_s[k] >= within.to_s) continue;
    if (auto window =
            tracker.push(record.t_s[k], record.u_V[k], record.y_m[k], first, readings.at(k))) {
      windows.push_back(std::move(*window));
    }
    first = false;
  }
  return windows;
}

void check(const IsolationRequest& request, const Record& record) {
  const double least_s = request.settings.window_s + tracking::kLead_s;
  const double length_s = static_cast<double>(record.size()) * record.sample_time_s;
  if (request.settings.window_s < kLeastSamples * record.sample_time_s) {
    throw UsageError(fmt::format(
        "--window: is too short for samples every {:.3g} s; allowed: 20 samples or more",
        record.sample_time_s));
  }
  if (length_s < least_s) {
    throw config::schema::bad_data(record.name, fmt::format("is too short: {:.3g} s", length_s),
                                   fmt::format("a window and its lead-in, {:.3g} s", least_s));
  }
  if (request.settings.observer_per_s * record.sample_time_s >= 1.0) {
    throw UsageError(
        fmt::format("--observer: is too fast for samples every {:.3g} s", record.sample_time_s));
  }
}

TimeSpan whole(const Record& record) {
  return {record.t_s.front(), record.t_s.back() + record.sample_time_s};
}

void check_healthy(const IsolationRequest& request, const Record& healthy, const Record& record) {
  check(request, healthy);
  if (std::abs(healthy.sample_time_s - record.sample_time_s) > 1e-6 * record.sample_time_s) {
    throw config::schema::bad_data(healthy.name,
                                   fmt::format("has another sample time than {}: {:.6g} s",
                                               record.name, healthy.sample_time_s),
                                   fmt::format("{:.6g} s", record.sample_time_s));
  }
}

void check_determined(const std::vector<WindowResult>& windows, const ParameterSet& set,
                      const std::string& where) {
  const std::optional<std::size_t> parameter = tracking::undetermined_parameter(windows, set);
  if (!parameter) return;
  const std::string found =
      windows.empty()
          ? "has no whole window"
          : "has no usable window: " +
                tracker::invalid_words(set, windows.back().estimates[*parameter].invalid);
  throw config::schema::bad_data(where, found,
                                 "a healthy motion that tells the parameters: --healthy from:to, "
                                 "--healthy-record with a record of its own, or --healthy-rms");
}

/// Baseline of a disturbed rig, by command and position; none: the process is not disturbed.
std::optional<Baseline> learn_disturbed(const plant_sim::ModelFile& model,
                                        const IsolationRequest& request, const Record& healthy,
                                        IsolationReport& out) {
  const ParameterSet set = tracking::choose(model, request.parameters, "--parameters");
  std::optional<Baseline> baseline = tracking::learn_disturbed_baseline(
      model, set, greybox::dataset_of(healthy), std::max(1U, std::thread::hardware_concurrency()));
  if (!baseline) return baseline;
  out.set = set;
  out.notes = healthy.notes;
  return baseline;
}

void note_calibration(IsolationReport& out) {
  const double times = out.baseline.rms_m / out.noise_floor_m;
  if (times > kUncalibrated && !out.baseline.noise) {
    out.notes.push_back(fmt::format("the healthy error is {:.3g}", times) +
                        " times the noise floor: the model lacks something that healthy data "
                        "show; calibrate it first (spoolwatch diagnose, fit)");
  }
  for (std::size_t i = 0; i < out.set.tracked; ++i) {
    const greybox::FreeParameter& p = out.set.parameters[i];
    const auto at = static_cast<Eigen::Index>(i);
    if (p.scale != greybox::ParameterScale::logarithmic) continue;
    const double off = std::exp(out.baseline.theta[at] - out.set.file[at]) - 1.0;
    if (std::abs(off) < kOffFile) continue;
    out.notes.push_back(
        "when healthy, " + tracker::name_words(p.name) +
        fmt::format(" is {:+.3g} % off the model file; changes count from there", 100.0 * off));
  }
}

void note_followed(IsolationReport& out, const ParameterTracker& tracker) {
  const tracking::BaselineDrift& slow = tracker.baseline_drift();
  for (std::size_t i = 0; i < slow.size(); ++i) {
    const std::size_t at = slow.parameter(i);
    const greybox::FreeParameter& p = out.set.parameters[at];
    const Eigen::VectorXd& baseline = tracker.baseline()->theta;
    out.notes.push_back(
        slow.at_end(i, baseline) != 0
            ? tracker::drift_words(p, slow.learnt(i), baseline[static_cast<Eigen::Index>(at)])
            : tracker::name_words(p.name) + " was followed from " +
                  tracker::value_words(p, slow.learnt(i), NAN) + " to " +
                  tracker::value_words(p, baseline[static_cast<Eigen::Index>(at)], NAN));
  }
}

void write_learnt(const IsolationRequest& request, const plant_sim::ModelFile& model,
                  const Record& record, const IsolationReport& out) {
  tracker::BaselineFile file = tracker::baseline_file(model, out.set, out.settings, out.baseline);
  file.rig_id = request.rig_id;
  file.source = record.name;
  file.sample_time_s = record.sample_time_s;
  file.noise_floor_m = std::isfinite(out.noise_floor_m) ? out.noise_floor_m : 0.0;
  config::record::write_whole(request.learn_baseline,
                              config::schema::print_toml([&](auto& v) { file.visit(v); }));
}

}  // namespace

IsolationReport isolate(const IsolationRequest& request) {
  files::check_outputs(
      {{"--json", request.json}, {"--report", request.report}, {"--learn", request.learn_baseline}},
      {request.model, {request.record}});
  const plant_sim::ModelFile model = plant_sim::load_model(request.model, request.assignments);
  const present::PrintedAxis axis(present::motion_of(model));
  plant_sim::require_constant(model);
  const Record record = config::record::read_record(request.record, request.reading);
  check(request, record);
  IsolationReport out;
  out.model = request.model;
  out.motion = config::units::motion();
  out.record = request.record;
  out.command = request.command;
  out.settings = request.settings;
  out.notes = record.notes;
  const bool own_record = !request.healthy_record.empty();
  const Record apart =
      own_record ? config::record::read_record(request.healthy_record, request.reading) : Record{};
  const Record& healthy = own_record ? apart : record;
  if (own_record) check_healthy(request, healthy, record);
  const Readings readings = readings_of(record, request);
  const Readings healthy_readings = readings_of(healthy, request);
  if (!healthy_readings.covers(readings)) {
    throw config::schema::bad_data(healthy.name, "lacks the pressures that " + record.name + " has",
                                   "--no-pressures");
  }
  out.set =
      tracking::choose(model, tracked_names(model, request, readings, out.notes), "--parameters");
  const auto floor = estimator::residual::noise_floor(record.y_m, record.sample_time_s);
  out.noise_floor_m = floor.sd_m;
  const double floor_m = std::isfinite(floor.sd_m) ? floor.sd_m : 0.0;
  const tracking::BaselineDrift follows(out.set, request.settings.drift, "--follow");
  const auto tracker = [&] {
    return ParameterTracker(model, out.set, request.settings, record.sample_time_s, floor_m);
  };
  if (request.baseline_rms_m > 0.0) {
    if (!request.learn_baseline.empty()) {
      throw UsageError("--learn: not possible with --healthy-rms");
    }
    out.baseline = {request.baseline_rms_m, out.set.file, {}};
  } else {
    const TimeSpan baseline = own_record ? whole(healthy) : span(request.baseline);
    ParameterTracker learning = tracker();
    const std::vector<WindowResult> windows = track(learning, healthy, healthy_readings, baseline);
    std::optional<Baseline> disturbed;
    if (tracking::look_disturbed(windows, out.set, floor_m)) {
      disturbed = learn_disturbed(model, request, cut(healthy, baseline), out);
    }
    if (!disturbed) {
      check_determined(windows, out.set,
                       own_record ? healthy.name : record.name + ": --healthy " + request.baseline);
      out.baseline = tracking::learn_baseline(windows, out.set, floor_m);
    } else {
      out.baseline = std::move(*disturbed);
    }
    out.learnt = true;
    out.baseline_from_s = baseline.from_s;
    out.baseline_to_s = baseline.to_s;
    note_calibration(out);
    if (!request.learn_baseline.empty()) write_learnt(request, model, healthy, out);
  }
  ParameterTracker judging = tracker();
  judging.take(out.baseline);
  out.windows = track(judging, record, readings, {-INFINITY, INFINITY});
  out.alarms = judging.detector().changes();
  note_followed(out, judging);
  return out;
}

}  // namespace workbench::isolate
