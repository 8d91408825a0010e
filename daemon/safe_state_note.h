// Null after a daemon was killed: the note that a running daemon leaves on disk, and the command
// that writes null to the valve of such a note or of a configuration.
#pragma once

#include <filesystem>
#include <iosfwd>

#include "daemon/daemon_config.h"

namespace monitor {

/// The note that a running daemon leaves on disk, so that another process can command null after
/// the daemon was killed. A file with the effective configuration. The file exists from before the
/// first write to the valve until null has been the last command.
class SafeStateNote {
 public:
  /// Throws config::schema::RunError when it cannot be written. Empty `file`: no note.
  SafeStateNote(std::filesystem::path file, DaemonConfig& config);
  /// Removes the file; call once the valve is at null. A process that dies leaves the file behind.
  void withdraw() const;

 private:
  std::filesystem::path file_;
};

/// Opens only the valve, writes null and closes it, retrying for up to 2 s, and reports on `log`.
/// Does nothing where no valve can have been left away from null. Returns the exit code; throws
/// config::schema::Error when the valve cannot be opened.
int write_null(const DaemonConfig& config, std::ostream& log);

/// The same for the configuration in a daemon's note, which is removed on success. Without a note
/// nothing is written.
int write_null(const std::filesystem::path& note, std::ostream& log);

}  // namespace monitor
