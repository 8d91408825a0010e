// One life of the daemon: everything that the configuration asks for, opened, run, and closed.
#pragma once

#include <functional>
#include <iosfwd>

#include "daemon/daemon_config.h"

namespace monitor {

struct SessionOptions {
  bool virtual_time = false;
  std::filesystem::path driving;  ///< where it is noted what is driven; empty: nowhere
  double duration_s = 0.0;        ///< of the loop's grid; 0: until a signal comes
  /// Reads the configuration once more; throws config::schema::Error.
  std::function<void(DaemonConfig&)> read;
};

/// Runs until the duration is over, the record ends or a signal comes. Returns the exit code;
/// throws config::schema::Error for what prevents a start. Says on `log` what privileges it got.
int run_session(DaemonConfig& config, const SessionOptions& options, std::ostream& log);

/// Opens and validates everything without writing to a device, prints the effective configuration
/// and, for each failure, how soon null is commanded and how far the rod may travel until then. A
/// device that cannot be reached is a DeviceUnavailable after all that.
void check_session(DaemonConfig& config, std::ostream& out);

}  // namespace monitor
