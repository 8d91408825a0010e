// What commissioning found on a rig, as a file: without one that fits, devices that move something
// are never armed.
//
// TOML: schema_version, rig_id, date; [valve] sign, null_V, dead_zone_V; [rod] sign, scale,
// noise_m; latency_s.
#pragma once

#include <filesystem>
#include <limits>
#include <string>

#include "config/schema/visitor.h"

namespace monitor::control {

struct Calibration {
  std::string rig_id;           ///< [rig] id of the configuration it was made with
  std::string date;             ///< YYYY-MM-DD, of the commissioning
  std::int64_t valve_sign = 1;  ///< +1: a higher voltage extends the rod
  double null_V = 0.0;          ///< where the rod stands still
  double dead_zone_V = 0.0;     ///< width of the range in which it does
  std::int64_t rod_sign = 1;    ///< +1: the raw reading grows as the rod extends
  double rod_scale = 1.0;       ///< metres a raw unit of the rod sensor
  double noise_m = 0.0;         ///< standard deviation of the reading at rest
  double latency_s = 0.0;       ///< from a command to the first motion

  void visit(config::schema::Visitor& v);
};

/// Throws config::schema::Error (exit 78) when it cannot be read or is of another rig.
[[nodiscard]] Calibration load_calibration(const std::filesystem::path& file,
                                           const std::string& rig_id);

/// The file's text.
[[nodiscard]] std::string print_calibration(Calibration calibration);

}  // namespace monitor::control
