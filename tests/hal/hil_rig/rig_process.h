// Runs the built spoolwatch-rig: on a free port of this machine, or to its end.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <string>
#include <vector>

namespace hal::hil_rig {

class RigProcess {
 public:
  /// With these arguments and --listen; waits until it listens.
  explicit RigProcess(const std::vector<std::string>& arguments, const std::string& listen = "0");
  ~RigProcess();
  RigProcess(const RigProcess&) = delete;
  RigProcess& operator=(const RigProcess&) = delete;

  /// "127.0.0.1:41234", empty when it did not start.
  [[nodiscard]] const std::string& address() const noexcept { return address_; }
  [[nodiscard]] int port() const;
  [[nodiscard]] pid_t pid() const noexcept { return pid_; }
  void signal(int number) const;
  /// Waits for the end; returns the exit code, -signal when one ended it.
  int wait();

 private:
  pid_t pid_ = -1;
  FILE* lines_ = nullptr;
  std::string address_;
};

struct Ended {
  int exit_code = -1;
  std::string err;
};

/// spoolwatch-rig with exactly these arguments, to its end.
Ended run_rig(const std::vector<std::string>& arguments);

/// config/NAME of the source tree.
std::string shipped_config(const std::string& name);

}  // namespace hal::hil_rig
