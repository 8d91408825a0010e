// What the service manager is told (sd_notify): that the daemon is ready, lives, ends, and what it
// does. Nothing is sent where none waits for it ($NOTIFY_SOCKET).
//
// One thread.
#pragma once

#include <cstdint>
#include <string>

namespace monitor::io {

class ServiceManager {
 public:
  ServiceManager();

  /// How long it waits for alive() before it takes the daemon for dead; 0: for ever.
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
