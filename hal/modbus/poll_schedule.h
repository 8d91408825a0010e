// Times at which the polling thread checks for commands, so that no tick has to wake it.
//
// The loop's period n begins at g + n T on the monotonic clock. A tick may come late, none comes
// early: the earliest calls show g. The thread looks h, 2 h, 3 h ... after the beginning of the
// period that it waits for, until the command is there: a command waits h at most, however late its
// tick. 50 ms after that beginning it stops, and the loop wakes it when it comes back.
//   T  period, h  hand-over
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>

#include "hal/device.h"

namespace hal::modbus {

inline constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();
/// After this time without a tick the loop itself no longer trusts its controller.
inline constexpr std::int64_t kSilence_ns = 50'000'000;

class PollSchedule {
 public:
  PollSchedule(std::int64_t period_ns, std::int64_t hand_over_ns) noexcept
      : period_ns_(period_ns), hand_over_ns_(hand_over_ns) {}

  // The loop's side.
  /// Reports the current tick.
  void tick(const Tick& tick, std::int64_t now_ns) noexcept {
    const std::int64_t begun_ns = now_ns - tick.nominal_ns;
    const std::int64_t known_ns = begun_ns_.load(std::memory_order_relaxed);
    const std::int64_t late_ns = begun_ns - known_ns;
    const bool kept = known_ns != kUnknown && late_ns >= 0 && late_ns <= kLostGrid * period_ns_;
    begun_ns_.store(kept ? known_ns + kCreep_ns : begun_ns, std::memory_order_relaxed);
  }
  /// Start of the next period; one period from now until the first tick is known.
  /// Async-signal-safe.
  [[nodiscard]] std::int64_t next_ns(std::int64_t now_ns) const noexcept {
    const std::int64_t known_ns = begun_ns_.load(std::memory_order_relaxed);
    if (known_ns == kUnknown) return now_ns + period_ns_;
    const std::int64_t into_ns = (now_ns - known_ns) % period_ns_;
    return now_ns - into_ns + (into_ns < 0 ? 0 : period_ns_);
  }

  // The thread's side.
  /// Next check for the command of the period that begins at begins_ns; kNever_ns: wait for a
  /// wake-up.
  [[nodiscard]] std::int64_t look_ns(std::int64_t begins_ns, std::int64_t now_ns) const noexcept {
    const std::int64_t into_ns = now_ns - begins_ns;
    if (begins_ns == 0 || into_ns >= kSilence_ns) return kNever_ns;
    const std::int64_t looks = into_ns < 0 ? 0 : into_ns / hand_over_ns_;
    return begins_ns + (looks + 1) * hand_over_ns_;
  }

 private:
  static constexpr std::int64_t kUnknown = kNever_ns;
  static constexpr std::int64_t kLostGrid = 20;  ///< periods
  /// Shift of the grid per period, which corrects an estimate that is too early.
  static constexpr std::int64_t kCreep_ns = 100;

  const std::int64_t period_ns_;
  const std::int64_t hand_over_ns_;
  std::atomic<std::int64_t> begun_ns_{kUnknown};  ///< period 0
};

}  // namespace hal::modbus
