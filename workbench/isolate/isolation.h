// Parameter tracking over a record: request, computation and results.
#pragma once

#include <string>
#include <vector>

#include "config/record/reading.h"
#include "config/units/quantity.h"
#include "estimator/greybox/tracking/parameter_tracker.h"
#include "workbench/present/report.h"

namespace workbench::isolate {

namespace tracking = estimator::greybox::tracking;

using tracking::Baseline;
using tracking::DetectedChange;
using tracking::ParameterChange;
using tracking::ParameterSet;
using tracking::ParameterTracker;
using tracking::Rival;
using tracking::TrackerSettings;
using tracking::WindowResult;

struct IsolationRequest {
  std::string model;
  std::string record;
  config::record::ReadOptions reading;
  std::vector<std::string> parameters{"supply_pressure_Pa,damping_N_s_per_m"};
  TrackerSettings settings;
  std::string baseline = "0:10";  ///< from:to, s
  std::string healthy_record;     ///< not empty: what is healthy is learned from all of this record
  double baseline_rms_m =
      0.0;  ///< above 0: given instead of estimated; the file's values are healthy
  std::string learn_baseline;  ///< file for the baseline, for [[tracker]] healthy
  std::string rig_id;          ///< noted in it
  bool no_pressures = false;   ///< the record's are not used
  std::vector<std::string> assignments;
  std::string json;  ///< "-": standard output
  std::string report;
  bool all_windows = false;
  std::string command;  ///< the command line as it was typed, for the report
};

struct IsolationReport {
  std::string model;
  config::units::Motion motion = config::units::Motion::linear;  ///< of the model's axis
  std::string record;
  std::string command;
  ParameterSet set;
  TrackerSettings settings;
  Baseline baseline;
  bool learnt = false;
  double baseline_from_s = 0.0;
  double baseline_to_s = 0.0;
  double noise_floor_m = 0.0;  ///< NaN: unknown
  std::vector<WindowResult> windows;
  std::vector<DetectedChange> alarms;
  std::vector<std::string> notes;
};

/// Reads everything and tracks. Throws config::schema::UsageError for options, DataError and
/// ConfigError for files that cannot be used.
[[nodiscard]] IsolationReport isolate(const IsolationRequest& request);

[[nodiscard]] std::string to_text(const IsolationReport& outcome, bool all_windows);

/// SI, a missing number is null: windows: [{t_s, from_s, NAME: {value, std_error, smallest, valid},
/// correlation, rms_m, pressures: {in_error_Pa, in_offset_Pa, out_error_Pa, out_offset_Pa} (where
/// they counted), left_out (why they did not), valid, why, part}], alarms: [{parameter, direction
/// ("high", "low"), value, std_error, healthy, change_ratio, confidence, ambiguity_group, rivals:
/// [{parameter, value}], raised_s, cleared_s, advice, words}], healthy: {rms_m, from_s, to_s,
/// values, pressures, disturbance}, noise_floor_m, parameters, limit_m, notes, fit_s (median of a
/// window).
[[nodiscard]] std::string to_json(const IsolationReport& outcome);

[[nodiscard]] present::Report to_report(const IsolationReport& outcome);

}  // namespace workbench::isolate
