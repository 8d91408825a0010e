// Commissioning of the rig that the configuration names: the stages of control/commissioning.h one
// after the other on its devices, each after a person has agreed, and the calibration file.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <limits>
#include <string>

#include "daemon/daemon_config.h"

namespace monitor {

struct CommissionOptions {
  static constexpr double kOpen = std::numeric_limits<double>::quiet_NaN();

  std::filesystem::path out;  ///< the calibration file
  double max_travel_m = 5e-3;
  double authority_V = kOpen;    ///< NaN: what cannot drive the rod farther than max_travel blindly
  double max_speed_mps = kOpen;  ///< NaN: max_travel in 0.1 s
  double pulse_s = 0.2;
  std::string home = "none";  ///< stop_above, stop_below, index_above, index_below
  double home_travel_m = 1.0;
  double stroke_m = kOpen;    ///< true way between the stops: both are driven to, for the scale
  bool yes = false;           ///< ask nobody
  bool virtual_time = false;  ///< only where no device is real
};

/// 128 + SIGINT, as a shell says it.
inline constexpr int kStoppedExitCode = 130;

/// Returns the exit code: 0 when the file has been written, 1 when it was given up, 130 when a
/// signal came. Throws config::schema::Error for what prevents a start. Whatever way it ends, the
/// valve is at null.
int commission(DaemonConfig& config, const CommissionOptions& options, std::ostream& out);

}  // namespace monitor
