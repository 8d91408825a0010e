// Ctrl-C while something long runs: the first signal asks it to stop; another one, SIGINT or
// SIGTERM, not at the same moment, ends the program.
#pragma once

#include <chrono>
#include <csignal>

namespace workbench::cli {

/// SIGINT and SIGTERM are caught while this lives, one such object at a time; afterwards they do
/// what they did before.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// May be called from any thread.
  [[nodiscard]] static bool requested() noexcept { return exit_code() != 0; }
  /// As shells report a program that a signal ended: 128 and its number; 0 when none came.
  [[nodiscard]] static int exit_code() noexcept;

 private:
  struct sigaction before_int_ {};
  struct sigaction before_term_ {};
};

/// End of a command that runs until it is stopped: a signal, or a time limit.
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
