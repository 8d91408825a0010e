// Faults of the simulated position sensor.
#pragma once

#include <string>
#include <vector>

#include "config/schema/visitor.h"

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

}  // namespace workbench::simulate
