// What the main thread does while the loop runs: it waits for the signals that ask the process to
// stop, and serves the control socket.
#pragma once

#include <csignal>

#include "daemon/command_desk.h"

namespace monitor {

/// SIGTERM, SIGINT, SIGHUP; blocked in every thread, so that they are waited for.
[[nodiscard]] sigset_t stop_signals();

/// Those signals as a file that can be waited for.
class StopFile {
 public:
  StopFile();
  ~StopFile();
  StopFile(const StopFile&) = delete;
  StopFile& operator=(const StopFile&) = delete;
  [[nodiscard]] int file() const noexcept { return file_; }
  [[nodiscard]] bool came() const noexcept;

 private:
  int file_;
};

class Attendant {
 public:
  /// `socket` may be null; both outlive this.
  Attendant(CommandDesk& desk, io::ControlSocket* socket) : desk_(desk), socket_(socket) {}

  /// Up to 100 ms. Returns whether the daemon is asked to stop.
  bool attend();

 private:
  CommandDesk& desk_;
  io::ControlSocket* socket_;
  StopFile stop_;
  bool soon_ = false;  ///< there is something to do
};

}  // namespace monitor
