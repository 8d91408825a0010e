// Notifications to the service manager (sd_notify): ready, keep-alive, stopping, status. Nothing is
// sent without $NOTIFY_SOCKET.
//
// One thread.
#pragma once

#include <cstdint>
#include <string>

namespace monitor::io {

class ServiceManager {
 public:
  ServiceManager();

  /// Watchdog time: the longest allowed interval between calls of alive(); 0: no watchdog.
  [[nodiscard]] std::int64_t watchdog_ns() const noexcept { return watchdog_ns_; }

  void ready() const;
  void alive() const;
  void stopping() const;
  /// One line, for `systemctl status`.
  void status(const std::string& line) const;

 private:
  std::int64_t watchdog_ns_ = 0;
};

}  // namespace monitor::io
