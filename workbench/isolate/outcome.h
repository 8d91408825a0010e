// A record's tracking, from what was asked for to what is told.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/tracking/parameter_tracker.h"
#include "workbench/present/report.h"

namespace workbench::isolate {

namespace tracking = estimator::greybox::tracking;

using tracking::Alarm;
using tracking::Choice;
using tracking::Healthy;
using tracking::Named;
using tracking::Rival;
using tracking::Settings;
using tracking::Tracker;
using tracking::Window;

struct Request {
  std::string model;
  std::string record;
  std::vector<std::string> parameters{"supply_pressure_Pa,damping_N_s_per_m"};
  Settings settings;
  std::string healthy = "0:10";  ///< from:to, s
  double healthy_rms_m = 0.0;  ///< above 0: given instead of learnt; the file's values are healthy
  std::string learn;           ///< file for what was learnt, for [[tracker]] healthy
  std::string rig_id;          ///< noted in it
  bool no_pressures = false;   ///< the record's are not used
  std::vector<std::string> assignments;
  std::string json;  ///< "-": standard output
  std::string report;
  bool all_windows = false;
  std::string command;  ///< the command line as it was typed, for the report
};

struct Outcome {
  std::string model;
  std::string record;
  std::string command;
  Choice choice;
  Settings settings;
  Healthy healthy;
  bool learnt = false;
  double healthy_from_s = 0.0;
  double healthy_to_s = 0.0;
  double noise_floor_m = 0.0;  ///< NaN: cannot be told
  std::vector<Window> windows;
  std::vector<Alarm> alarms;
  std::vector<std::string> notes;
};

/// Reads everything and tracks. Throws config::schema::UsageError for options, DataError and
/// ConfigError for files that cannot be used.
[[nodiscard]] Outcome isolate(const Request& request);

[[nodiscard]] std::string to_text(const Outcome& outcome, bool all_windows);

/// SI, a missing number is null: windows: [{t_s, from_s, NAME: {value, std_error, smallest, valid},
/// correlation, rms_m, pressures: {in_error_Pa, in_offset_Pa, out_error_Pa, out_offset_Pa} (where
/// they counted), left_out (why they did not), valid, why, part}], alarms: [{parameter, direction
/// ("high", "low"), value, std_error, healthy, change_ratio, confidence, ambiguity_group, rivals:
/// [{parameter, value}], raised_s, cleared_s, advice, words}], healthy: {rms_m, from_s, to_s,
/// values, pressures}, noise_floor_m, parameters, limit_m, notes, fit_s (median of a window).
[[nodiscard]] std::string to_json(const Outcome& outcome);

[[nodiscard]] present::Report to_report(const Outcome& outcome);

}  // namespace workbench::isolate
