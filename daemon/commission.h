// Commissions the configured rig: runs the stages of control/commissioning.h on its devices, each
// after the operator has agreed, and writes the calibration file.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <limits>
#include <string>

#include "daemon/daemon_config.h"

namespace monitor {

struct CommissionOptions {
  static constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();

  std::filesystem::path out;  ///< the calibration file
  double max_travel_m = 5e-3;
  double authority_V = kUnset;    ///< NaN: limited so that a blind pulse stays within max_travel
  double max_speed_mps = kUnset;  ///< NaN: max_travel in 0.1 s
  double pulse_s = 0.2;
  std::string home = "none";  ///< stop_above, stop_below, index_above, index_below
  double home_travel_m = 1.0;
  double stroke_m = kUnset;   ///< true distance between the stops; NaN: the scale is not determined
  bool yes = false;           ///< do not ask the operator
  bool virtual_time = false;  ///< only without real devices
};

/// 128 + SIGINT, the shell convention.
inline constexpr int kStoppedExitCode = 130;

/// Returns the exit code: 0 when the file was written, 1 when commissioning was aborted, 130 on a
/// signal. Throws config::schema::Error when it cannot start. The valve is at null in every case.
int commission(DaemonConfig& config, const CommissionOptions& options, std::ostream& out);

}  // namespace monitor
