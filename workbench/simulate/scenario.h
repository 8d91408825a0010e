// Everything that a closed-loop simulation needs besides its length: a model file, and optional
// tables beside those of the model.
//
//   [reference]     kind, centre_m, amplitude_m, ... (daemon/control/reference.h)
//   [instruments]   encoder_resolution_m, noise_m, dac_bits, dac_range_V,
//                   pressure_noise_Pa
//   [[fault]]       parameter, at_s, value or factor, ramp_s (plant_sim/schedule.h)
//   [[sensor_fault]]  kind, at_s, size (SensorFault)
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/control/reference.h"
#include "plant_sim/model_file.h"
#include "plant_sim/schedule.h"
#include "workbench/simulate/instruments.h"
#include "workbench/simulate/sensor_fault.h"

namespace config::schema {
class Document;
class Visitor;
}  // namespace config::schema

namespace workbench::simulate {

struct Scenario {
  plant_sim::ModelFile model;
  monitor::control::ReferenceConfig reference;
  std::filesystem::path folder;  ///< where a relative reference file starts from
  Instruments instruments;
  std::vector<plant_sim::Change> faults;
  std::vector<SensorFault> sensor_faults;

  void visit(config::schema::Visitor& v);
};

/// Throws config::schema::ConfigError for an unknown key or a bad value.
[[nodiscard]] Scenario read_scenario(const config::schema::Document& document);

}  // namespace workbench::simulate
