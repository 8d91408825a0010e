// The container that scripts/container has booted beside this test, seen from outside.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

namespace service {

struct Output {
  int exit_code = -1;
  std::string text;  ///< both streams
};

class Machine {
 public:
  /// Runs in $SPOOLWATCH_CONTAINER.
  Machine();

  /// A shell command inside, as root.
  Output run(const std::string& command) const;
  /// One property of the service, as `systemctl show` gives it.
  [[nodiscard]] std::string property(const std::string& name) const;
  /// Waits, 20 s at most, until the property begins like that.
  [[nodiscard]] bool becomes(const std::string& property, const std::string& begin) const;
  /// The daemon's process as this machine numbers it, 0 when it does not run.
  [[nodiscard]] pid_t daemon() const;
  /// When the service last began to stop, on the monotonic clock.
  [[nodiscard]] std::int64_t stopped_ns() const;
  /// When systemd last wrote a line with that to the journal, on the monotonic clock: what is left
  /// of a unit that has gone with its package.
  [[nodiscard]] std::int64_t logged_ns(const std::string& words) const;
  void write(const std::string& path, const std::string& text) const;

 private:
  std::string init_;
};

}  // namespace service
