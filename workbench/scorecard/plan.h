// Plan of a scorecard: the rig, motions, faults with their sizes, and what is no fault.
//
// TOML (config/scorecard/plan.toml):
//   model, lead_s, phase_s, watch_s, training_s, healthy_h, full_h, benign_h, part_h
//   [instruments]  as in simulations
//   [[motion]]     id, and the keys of [reference]
//   [[fault]]      id, parameter or sensor, how, direction, unit, per_unit, stated, least,
//                  greatest, names
//   [[benign]]     id, what; parameter, how, size, ramp; amplitude_ratio, frequency_ratio
#pragma once

#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "workbench/simulate/scenario.h"

namespace workbench::scorecard {

struct Motion {
  std::string id;
  monitor::control::ReferenceConfig reference;

  void visit(config::schema::Visitor& v);
};

struct Fault {
  std::string id;
  std::string parameter;           ///< parameter of the model, or else:
  std::string sensor;              ///< a kind of simulate::SensorFault
  std::string how = "ratio";       ///< ratio: old (1 +- size), value: +-size; of a parameter
  std::string direction = "both";  ///< up, down, both
  std::string unit = "%";
  double per_unit = 0.01;  ///< SI, or a ratio, of one unit
  double stated = 10.0;    ///< size at which delay and names are judged, in units; 0: has no size
  double least = 0.0;      ///< rungs of the ladder, in units
  double greatest = 0.0;
  std::vector<std::string> names;  ///< that are right; empty in the file: the parameter

  void visit(config::schema::Visitor& v);
  [[nodiscard]] std::vector<int> directions() const;  ///< +1, -1
  /// 1, 1.5, 2, 3, 5, 7 of every decade from least to greatest, in units; a ratio downwards stays
  /// short of -95 %.
  [[nodiscard]] std::vector<double> sizes(int sign) const;
};

/// A change that is no fault, from the beginning of a record or over ramp_s.
struct Benign {
  std::string id;
  std::string what;
  std::string parameter;  ///< empty: none
  double factor = 1.0;
  double ramp_s = 0.0;
  double amplitude_ratio = 1.0;  ///< scales the motion
  double frequency_ratio = 1.0;

  void visit(config::schema::Visitor& v);
};

struct Plan {
  std::string model = "../models/thesis_calibrated.toml";
  double lead_s = 12.0;   ///< healthy, before the earliest fault
  double phase_s = 4.0;   ///< the fault comes at random within
  double watch_s = 20.0;  ///< time to detect it
  double training_s = 1800.0;
  double healthy_h = 12.0;  ///< over all motions
  double full_h = 72.0;     ///< the same, of a full run
  double benign_h = 3.0;    ///< for each change, over all motions
  double part_h = 0.5;      ///< length of one healthy record
  simulate::Instruments instruments{5e-6, 2e-6, 12, 10.0};
  std::vector<Motion> motions;
  std::vector<Fault> faults;
  std::vector<Benign> benign;

  void visit(config::schema::Visitor& v);
};

/// A plan and the model that it names.
struct Bench {
  Plan plan;
  simulate::Scenario healthy;  ///< without reference and faults
  std::string text;            ///< plan and model as they are in effect: what results depend on
};

/// `file` empty: the shipped one. Throws config::schema::ConfigError.
[[nodiscard]] Bench load_bench(const std::string& file);

}  // namespace workbench::scorecard
