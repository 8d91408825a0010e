// [[tracker]]: physical parameters tracked on line, as a source of the fault detection.
//
//   [[tracker]]
//   id = "physics"
//   model = "models/thesis.toml"          # of the healthy rig
//   parameters = ["supply_pressure_Pa", "damping_N_s_per_m"]
//   healthy = "healthy.toml"              # from `spoolwatch isolate --learn`; or learn_s
//
// Pressures that the rig reads are used (`pressures = false`: not). The supply's takes the place of
// the fit of supply_pressure_Pa; the chambers' are fitted beside the position (tracker.h) once what
// they are like when healthy is known: from learn_s, or from a file that was learnt with them; an
// older file leaves them out. With either the valve gain can be told from the supply pressure, and
// valve_gain_m_per_V should stand in `parameters`: it is not added by itself. Where it does not, a
// change of the gain is found "unexplained" beside a reading of the supply, and by position alone,
// as the group of both, beside readings of the chambers. What was left out is said in the finding's
// reason.
//
// Its values: each parameter by its name (a dot in it becomes "_"), NaN where the window does not
// tell it; smallest_NAME, the change that the present motion would show; residual_rms_m;
// healthy_NAME of each parameter of `follow`, which changes are counted from (slow_change.h). Its
// alarms: each parameter by the same name, which name the parameter or the group that cannot be
// told apart; slow_NAME when one of `follow` has come further by and by than is followed; and
// "unexplained" when the model no longer explains the rig.
#pragma once

#include <string>
#include <vector>

#include "estimator/fdi/alarm.h"
#include "estimator/fdi/detection_method_config.h"
#include "estimator/fdi/tracker/baseline_file.h"
#include "estimator/greybox/tracking/parameter_tracker.h"

namespace estimator::fdi::tracker {

struct TrackerConfig final : estimator::fdi::DetectionMethodConfigOf<TrackerConfig> {
  TrackerConfig();

  std::string model;       ///< file, relative to the configuration; read by load()
  std::string model_toml;  ///< what stood in it
  std::vector<std::string> parameters{"supply_pressure_Pa", "damping_N_s_per_m"};
  greybox::tracking::TrackerSettings settings;
  std::string baseline;  ///< file; "": learnt from the first learn_s of motion
  double learn_s = 10.0;
  bool pressures = true;  ///< those of the samples are used
  BaselineFile learnt;    ///< what stood in the file
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
