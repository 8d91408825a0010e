// What the main thread does while the loop runs: it waits for the signals that ask the process to
// stop or to read its configuration again, and serves the control socket.
#pragma once

#include <csignal>

#include "daemon/command_desk.h"

namespace monitor {

/// SIGTERM, SIGINT, SIGHUP; blocked in every thread, so that they are waited for. In a session
/// SIGHUP asks for the configuration to be read again.
[[nodiscard]] sigset_t stop_signals();

/// Those signals as a file that can be waited for.
class StopFile {
 public:
  StopFile();
  ~StopFile();
  StopFile(const StopFile&) = delete;
  StopFile& operator=(const StopFile&) = delete;
  [[nodiscard]] int file() const noexcept { return file_; }
  /// Whether any came.
  [[nodiscard]] bool came() const noexcept { return take() != 0; }
  /// The next that came, 0: none.
  [[nodiscard]] int take() const noexcept;

 private:
  int file_;
};

class Attendant {
 public:
  /// `socket` may be null; all of it outlives this.
  Attendant(CommandDesk& desk, io::ControlSocket* socket, Reloader& reloader)
      : desk_(desk), socket_(socket), reloader_(reloader) {}

  /// Up to 100 ms. Returns whether the daemon is asked to stop.
  bool attend();

 private:
  CommandDesk& desk_;
  io::ControlSocket* socket_;
  Reloader& reloader_;
  StopFile stop_;
  bool hung_up_ = false;  ///< a reload is asked for
  bool soon_ = false;     ///< there is something to do
};

}  // namespace monitor
