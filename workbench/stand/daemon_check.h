// The daemon's own check of a configuration (`spoolwatchd --check`), which reads from devices and
// never writes to one.
#pragma once

#include <filesystem>
#include <string>

namespace workbench::stand {

struct DaemonCheck {
  bool valid = false;      ///< all that can be checked without the device
  std::string complaint;   ///< one line; of a valid one: why no device was asked; or empty
  std::string properties;  ///< the comment lines of --check: times to null, readings
};

/// The spoolwatchd next to this program.
[[nodiscard]] std::filesystem::path daemon_program();

/// Throws config::schema::RunError where the daemon cannot be run.
[[nodiscard]] DaemonCheck check_with_daemon(const std::filesystem::path& configuration);

}  // namespace workbench::stand
