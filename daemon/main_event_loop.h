// The main thread's event loop: serves the control socket and handles the signals that stop the
// process or reload its configuration.
#pragma once

#include <csignal>

#include "daemon/control_request_handler.h"

namespace monitor {

/// SIGTERM, SIGINT, SIGHUP; blocked in every thread and received through SignalFd. In a session
/// SIGHUP reloads the configuration.
[[nodiscard]] sigset_t stop_signals();

/// A signalfd for stop_signals(), to be used with poll().
class SignalFd {
 public:
  SignalFd();
  ~SignalFd();
  SignalFd(const SignalFd&) = delete;
  SignalFd& operator=(const SignalFd&) = delete;
  [[nodiscard]] int fd() const noexcept { return fd_; }
  /// True when a signal was pending; consumes one.
  [[nodiscard]] bool pending() const noexcept { return next() != 0; }
  /// The next pending signal, 0 when there is none.
  [[nodiscard]] int next() const noexcept;

 private:
  int fd_;
};

class MainEventLoop {
 public:
  /// `socket` may be null. All arguments must outlive this object.
  MainEventLoop(ControlRequestHandler& handler, io::ControlSocket* socket, Reloader& reloader)
      : handler_(handler), socket_(socket), reloader_(reloader) {}

  /// Waits up to 100 ms for events and handles them. Returns true on a request to stop.
  bool run_once();

 private:
  ControlRequestHandler& handler_;
  io::ControlSocket* socket_;
  Reloader& reloader_;
  SignalFd signals_;
  bool reload_pending_ = false;  ///< SIGHUP has been received
  bool busy_ = false;            ///< answers or requests are pending
};

}  // namespace monitor
