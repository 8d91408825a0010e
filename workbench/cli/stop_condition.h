// When a command that runs until it is told to stop shall end: a signal, or the end of its time.
#pragma once

#include <chrono>

namespace workbench::cli {

class StopCondition {
 public:
  /// SIGINT, SIGTERM and SIGHUP end it; so do `duration_s` seconds, unless they are 0.
  explicit StopCondition(double duration_s);
  [[nodiscard]] bool reached() const;
  /// By a signal.
  [[nodiscard]] static bool asked() noexcept;

 private:
  using Clock = std::chrono::steady_clock;
  bool limited_;
  Clock::time_point at_;
};

}  // namespace workbench::cli
