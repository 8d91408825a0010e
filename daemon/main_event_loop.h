// What the main thread does while the loop runs: it waits for the signals that ask the process to
// stop or to read its configuration again, and serves the control socket.
#pragma once

#include <csignal>

#include "daemon/control_request_handler.h"

namespace monitor {

/// SIGTERM, SIGINT, SIGHUP; blocked in every thread, so that they are waited for. In a session
/// SIGHUP asks for the configuration to be read again.
[[nodiscard]] sigset_t stop_signals();

/// Those signals as a file that can be waited for.
class SignalFd {
 public:
  SignalFd();
  ~SignalFd();
  SignalFd(const SignalFd&) = delete;
  SignalFd& operator=(const SignalFd&) = delete;
  [[nodiscard]] int fd() const noexcept { return fd_; }
  /// Whether any came.
  [[nodiscard]] bool pending() const noexcept { return next() != 0; }
  /// The next that came, 0: none.
  [[nodiscard]] int next() const noexcept;

 private:
  int fd_;
};

class MainEventLoop {
 public:
  /// `socket` may be null; all of it outlives this.
  MainEventLoop(ControlRequestHandler& handler, io::ControlSocket* socket, Reloader& reloader)
      : handler_(handler), socket_(socket), reloader_(reloader) {}

  /// Up to 100 ms. Returns whether the daemon is asked to stop.
  bool run_once();

 private:
  ControlRequestHandler& handler_;
  io::ControlSocket* socket_;
  Reloader& reloader_;
  SignalFd signals_;
  bool hung_up_ = false;  ///< a reload is asked for
  bool soon_ = false;     ///< there is something to do
};

}  // namespace monitor
