// What commissioning found on a rig, as a file: without one that fits, devices that move something
// are never armed.
//
// Signs and scale are those of what the configuration makes of the devices: 1 and 1 where it fits.
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
  std::string rig_id;           ///< [rig] id of the configuration it was made with
  std::string date;             ///< YYYY-MM-DD, of the commissioning
  std::string wiring;           ///< of the configuration (print_wiring()), empty: not said
  std::int64_t valve_sign = 1;  ///< +1: a higher voltage extends the rod
  double null_V = 0.0;          ///< where the rod stands still
  double dead_zone_V = 0.0;     ///< width of the range in which it does
  /// Speed by voltage outside the dead zone; 0: not said.
  double gain_mps_per_V = 0.0;
  std::int64_t rod_sign = 1;  ///< +1: the reading grows as the rod extends
  double rod_scale = 1.0;     ///< true metres a metre of reading; 1 where nobody knew better
  double noise_m = 0.0;       ///< standard deviation of the reading at rest
  double latency_s = 0.0;     ///< from a command to the motion: dead time and lag
  std::string home = "none";  ///< or stop_above, stop_below, index
  double home_m = std::numeric_limits<double>::quiet_NaN();  ///< the reading there
  /// Within which it was found; 0: not said.
  double authority_V = 0.0;
  double max_travel_m = 0.0;
  double max_speed_mps = 0.0;

  void visit(config::schema::Visitor& v);
};

/// Throws config::schema::ConfigError when it cannot be read or is of another rig.
[[nodiscard]] Calibration load_calibration(const std::filesystem::path& file,
                                           const std::string& rig_id);

/// What the calibration says against a configuration, in one line; empty: nothing. A command at
/// `null_V` must let the rod stand: within the dead zone, or next to it by 1 % of limit_V.
[[nodiscard]] std::string contradiction(const Calibration& calibration, double null_V,
                                        double limit_V, const std::string& wiring);

/// The file's text.
[[nodiscard]] std::string print_calibration(Calibration calibration);

}  // namespace monitor::control
