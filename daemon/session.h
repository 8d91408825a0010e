// One run of the daemon: opens everything that the configuration asks for, runs the loop, closes.
#pragma once

#include <functional>
#include <iosfwd>

#include "daemon/daemon_config.h"
#include "daemon/rt/clock.h"

namespace monitor {

struct SessionOptions {
  bool virtual_time = false;
  std::filesystem::path driving;  ///< file of the SafeStateNote; empty: none
  double duration_s = 0.0;        ///< on the loop's grid; 0: until a signal
  rt::Clock* clock = nullptr;     ///< in virtual time, in place of an even one
  /// Reads the configuration for a reload; throws config::schema::Error.
  std::function<void(DaemonConfig&)> read;
};

/// Runs until the duration is over, the record ends or a signal arrives. Returns the exit code;
/// throws config::schema::Error when the session cannot start. Logs the privileges granted.
int run_session(DaemonConfig& config, const SessionOptions& options, std::ostream& log);

/// Opens and validates everything without writing to a device, then prints the effective
/// configuration and the null table. Finally throws DeviceUnavailable when a device cannot be
/// reached.
void check_session(DaemonConfig& config, std::ostream& out);

}  // namespace monitor
