// What the loop counts. The loop writes, any thread reads.
#pragma once

#include <atomic>
#include <cstdint>

#include "daemon/control/arming.h"
#include "daemon/rt/histogram.h"

namespace monitor::rt {

enum class Trip : std::uint8_t { none, overrun, reading, write };

/// A counter with one writer.
class Counter {
 public:
  void add(std::int64_t n = 1) noexcept { value_.store(value() + n, std::memory_order_relaxed); }
  [[nodiscard]] std::int64_t value() const noexcept {
    return value_.load(std::memory_order_relaxed);
  }

 private:
  std::atomic<std::int64_t> value_{0};
};

struct LoopStats {
  Counter ticks;
  Counter overruns;  ///< late wake-ups that skipped periods
  Counter skipped_periods;
  Counter dropped_samples;  ///< queue to the detector full
  Counter expired_commands;
  Counter refused_commands;  ///< not allowed in the state of the moment
  Counter rod_good, rod_bad, valve_good, valve_bad;
  Histogram lateness, read, control, write, tick;
  std::atomic<control::State> state{control::State::disarmed};
  std::atomic<Trip> trip{Trip::none};  ///< why the state is LATCHED
};

}  // namespace monitor::rt
