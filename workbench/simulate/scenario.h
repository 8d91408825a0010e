// Everything that a closed-loop simulation needs besides its length: a model file, and optional
// tables beside those of the model.
//
//   [reference]     kind, centre_m, amplitude_m, ... (daemon/control/reference.h)
//   [instruments]   encoder_resolution_m, noise_m, dac_bits, dac_range_V,
//                   pressure_noise_Pa
//   [[fault]]       parameter, at_s, value or factor, ramp_s (plant_sim/schedule.h)
//   [[sensor_fault]]  kind, at_s, size (SensorFault)
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "daemon/control/reference.h"
#include "plant_sim/model_file.h"
#include "plant_sim/schedule.h"

namespace config::schema {
class Document;
class Visitor;
}  // namespace config::schema

namespace workbench::simulate {

/// Faults of the position sensor, inside the loop: the controller sees them as the monitor does.
///
///   offset   y + size                      from at_s on; size in m
///   drift    y + size (t - at_s)           size in m/s
///   scale    y_at + (1 + size) (y - y_at)  counts lost or gained with every step, y_at the reading
///                                          at at_s; size a ratio
///   freeze   the last reading, for good    size has no meaning
///
/// offset, drift and scale act on the signal, before the encoder's steps and noise.
/// TOML [[sensor_fault]].
struct SensorFault {
  std::string kind = "offset";
  double at_s = 0.0;
  double size = 0.0;

  void visit(config::schema::Visitor& v);
};

/// A signal with a list of sensor faults, sample by sample in the order of time.
class FaultySensor {
 public:
  explicit FaultySensor(std::vector<SensorFault> faults);

  /// The signal that reaches the encoder for the true one.
  [[nodiscard]] double signal_m(double t_s, double y_m) noexcept;
  /// The reading for the encoder's output.
  [[nodiscard]] double reading_m(double t_s, double encoder_m) noexcept;

 private:
  struct Entry {
    SensorFault fault;
    bool started = false;
    double held_m = 0.0;  ///< scale: where the rod was; freeze: the reading
  };
  std::vector<Entry> entries_;
  double last_m_ = 0.0;  ///< reading
};

/// Instruments between the plant and the controller. The defaults are ideal: no steps, no noise.
struct Instruments {
  double encoder_resolution_m = 0.0;
  double noise_m = 0.0;            ///< standard deviation, before the encoder's rounding
  std::int64_t dac_bits = 0;       ///< 0: no steps
  double dac_range_V = 10.0;       ///< also the controller's limit
  double pressure_noise_Pa = 0.0;  ///< standard deviation, of each transducer

  void visit(config::schema::Visitor& v);
};

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
