// The calibration file that commissioning writes. Real devices are never armed without a matching
// one.
//
// Signs and scale are relative to the configuration: 1 where it is right.
//
// TOML: schema_version, rig_id, date, wiring, latency_s; [valve] sign, null_V, dead_zone_V,
// gain_mps_per_V; [rod] sign, scale, noise_m; [home] kind, position_m; [limits] authority_V,
// max_travel_m, max_speed_mps.
#pragma once

#include <filesystem>
#include <limits>
#include <string>

#include "config/schema/visitor.h"

namespace monitor::control {

struct Calibration {
  std::string rig_id;           ///< [rig] id at commissioning
  std::string date;             ///< date of commissioning, YYYY-MM-DD
  std::string wiring;           ///< hash at commissioning; empty: unknown
  std::int64_t valve_sign = 1;  ///< +1: a higher voltage extends the rod
  double null_V = 0.0;          ///< where the rod stands still
  double dead_zone_V = 0.0;     ///< width of the range of voltages without motion
  /// Speed per voltage outside the dead zone; 0: unknown.
  double gain_mps_per_V = 0.0;
  std::int64_t rod_sign = 1;  ///< +1: the reading grows as the rod extends
  double rod_scale = 1.0;     ///< true metres per metre of reading; 1 when not measured
  double noise_m = 0.0;       ///< standard deviation of the reading at rest
  double latency_s = 0.0;     ///< from command to motion: dead time and lag
  std::string home = "none";  ///< or stop_above, stop_below, index
  double home_m = std::numeric_limits<double>::quiet_NaN();  ///< the reading there
  /// Limits during commissioning; 0: unknown.
  double authority_V = 0.0;
  double max_travel_m = 0.0;
  double max_speed_mps = 0.0;

  void visit(config::schema::Visitor& v);
};

/// Throws config::schema::ConfigError when the file cannot be read or belongs to another rig.
[[nodiscard]] Calibration load_calibration(const std::filesystem::path& file,
                                           const std::string& rig_id);

/// Contradiction between the calibration and a configuration, in one line; empty: none. `null_V`
/// must lie within the dead zone, or at most 1 % of limit_V outside.
[[nodiscard]] std::string contradiction(const Calibration& calibration, double null_V,
                                        double limit_V, const std::string& wiring);

/// The text of the file.
[[nodiscard]] std::string print_calibration(Calibration calibration);

}  // namespace monitor::control
