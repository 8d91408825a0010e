// [[tracker]]: physical parameters tracked on line, as a detection method.
//
//   [[tracker]]
//   id = "physics"
//   model = "models/thesis.toml"          # the healthy rig
//   parameters = ["supply_pressure_Pa", "damping_N_s_per_m"]
//   healthy = "healthy.toml"              # from `spoolwatch isolate --learn`; or learn_s
//
// Pressures that the rig reads are used unless `pressures = false`. The supply pressure's mean
// replaces the fit of supply_pressure_Pa. Chamber pressures are fitted beside the position
// (parameter_tracker.h) once their healthy errors are known: from learn_s, or from a file learned
// with them; an older file leaves them out. With either reading, valve gain and supply pressure are
// separable, and valve_gain_m_per_V should be listed in `parameters`; it is not added by itself.
// Where it is missing, a change of the gain is reported as "unexplained" beside a reading of the
// supply, and as the group of both parameters beside readings of the chambers. The reason of a
// window states the pressures that were left out.
//
// Values: each parameter by its name (a dot becomes "_"), NaN where the window does not determine
// it; smallest_NAME, the smallest change that the present motion shows; residual_rms_m;
// healthy_NAME of each parameter of `follow`, the reference of its changes (baseline_drift.h). With
// a disturbed healthy file or learn_disturbance_s, what disturbs the rig now: disturbance_force_N
// (or disturbance_speed_mps), RMS, and frequency and amplitude of the strongest line of each site,
// disturbance_pressure_line_Hz and disturbance_pressure_line_Pa, likewise force and sensor; NaN
// where there is none.
// Alarms: each parameter by the same name, with the parameter or the group that cannot be
// separated; slow_NAME when a parameter of `follow` has drifted to the end of its range;
// "unexplained" when the model no longer explains the rig.
#pragma once

#include <string>
#include <vector>

#include "estimator/fdi/alarm.h"
#include "estimator/fdi/detection_method_config.h"
#include "estimator/fdi/tracker/baseline_file.h"
#include "estimator/fdi/tracker/detection_method_kinds.h"
#include "estimator/greybox/tracking/parameter_tracker.h"

namespace estimator::fdi::tracker {

struct TrackerConfig final : estimator::fdi::DetectionMethodConfigOf<TrackerConfig> {
  TrackerConfig();

  std::string model;       ///< file, relative to the configuration; read by load()
  std::string model_toml;  ///< text of the model file
  std::vector<std::string> parameters{"supply_pressure_Pa", "damping_N_s_per_m"};
  greybox::tracking::TrackerSettings settings;
  std::string baseline;  ///< file; "": learned from the first learn_s of motion
  double learn_s = 10.0;
  double learn_disturbance_s = 0.0;  ///< 0: the process is not disturbed
  bool pressures = true;             ///< use the pressures of the samples
  BaselineFile learnt;               ///< contents of the file
  std::string severity = "major";
  estimator::fdi::AlarmRules rules;

  void visit(config::schema::Visitor& v) override;
  void load(const estimator::fdi::ConfigLoadContext& context) override;
  [[nodiscard]] std::unique_ptr<estimator::fdi::DetectionMethod> make(
      const estimator::fdi::MethodContext& context) const override;

 private:
  [[nodiscard]] std::string where() const { return "[[tracker]] " + id; }
};

}  // namespace estimator::fdi::tracker
