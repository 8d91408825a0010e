// What a daemon leaves to others when it is killed: a note of what it drives, and the way to write
// null with nothing but that note.
#pragma once

#include <filesystem>
#include <iosfwd>

#include "daemon/daemon_config.h"

namespace monitor {

/// A file with the effective configuration, there from before the first write to the valve until
/// null has been its last command.
class SafeStateNote {
 public:
  /// Throws config::schema::RunError when it cannot be written. Empty `file`: no note.
  SafeStateNote(std::filesystem::path file, DaemonConfig& config);
  /// Null is at the valve. Not called by a process that dies: then the note stays.
  void withdraw() const;

 private:
  std::filesystem::path file_;
};

/// Opens the valve alone, writes null and closes it, trying for up to 2 s; says on `log` what it
/// did. Nothing is done where there is no valve that a dead process can have left anywhere. Returns
/// the exit code; throws config::schema::Error for what cannot be opened.
int write_null(const DaemonConfig& config, std::ostream& log);

/// The same from the note that a daemon has left; no note: nothing is driven. The note goes with
/// success.
int write_null(const std::filesystem::path& note, std::ostream& log);

}  // namespace monitor
