// The absolute time grid: period n begins at start + n * period. A wake-up that is late by a period
// or more skips whole periods and waits for the next grid point, so the phase is kept.
#pragma once

#include <array>
#include <cstdint>

#include "daemon/rt/clock.h"
#include "hal/device.h"

namespace monitor::rt {

struct Period {
  hal::Tick tick;
  std::int64_t lateness_ns = 0;  ///< lateness of the wake-up for this tick
  std::int64_t overrun_ns = 0;   ///< lateness of the wake-up that skipped periods, else 0
  std::int64_t skipped = 0;      ///< periods lost since the previous tick
};

class Grid {
 public:
  /// Period 0 begins at start_ns.
  Grid(std::int64_t start_ns, std::int64_t period_ns) noexcept
      : start_ns_(start_ns), period_ns_(period_ns) {}

  /// Waits for the next period.
  Period next(Clock& clock) noexcept {
    Period period;
    for (;;) {
      const std::int64_t due_ns = start_ns_ + index_ * period_ns_;
      clock.sleep_until_ns(due_ns);
      const std::int64_t late_ns = clock.now_ns() - due_ns;
      if (late_ns < period_ns_) {
        period.tick = {index_, index_ * period_ns_};
        period.lateness_ns = late_ns;
        ++index_;
        return period;
      }
      const std::int64_t lost = late_ns / period_ns_ + 1;
      if (period.overrun_ns == 0) period.overrun_ns = late_ns;
      period.skipped += lost;
      index_ += lost;
    }
  }

  /// Index of the period that next() waits for first.
  [[nodiscard]] std::int64_t index() const noexcept { return index_; }

 private:
  std::int64_t start_ns_;
  std::int64_t period_ns_;
  std::int64_t index_ = 0;
};

/// Overrun limit: more than `in_a_row` periods lost without a good tick in between, or more than
/// `a_minute` periods lost within 60 s. Fixed memory.
inline constexpr std::int64_t kMaxOverrunsAMinute = 1000;

class OverrunRule {
 public:
  OverrunRule(std::int64_t in_a_row, std::int64_t a_minute) noexcept
      : in_a_row_(in_a_row),
        a_minute_(a_minute < kMaxOverrunsAMinute ? a_minute : kMaxOverrunsAMinute) {}

  /// Records `skipped` lost periods before the tick at time_ns. Returns true beyond the limit.
  bool add(std::int64_t skipped, std::int64_t time_ns) noexcept {
    if (skipped == 0) {
      row_ = 0;
      return false;
    }
    row_ += skipped;
    bool too_many = row_ > in_a_row_;
    // The ring holds the times of the a_minute_ + 1 newest losses.
    const std::int64_t size = a_minute_ + 1;
    const std::int64_t kept = skipped < size ? skipped : size;
    for (std::int64_t i = 0; i < kept; ++i) {
      lost_ns_[static_cast<std::size_t>(count_ % size)] = time_ns;
      ++count_;
      const std::int64_t oldest_ns = lost_ns_[static_cast<std::size_t>(count_ % size)];
      if (count_ >= size && time_ns - oldest_ns < kMinute_ns) too_many = true;
    }
    return too_many;
  }

 private:
  static constexpr std::int64_t kMinute_ns = 60'000'000'000;

  std::int64_t in_a_row_;
  std::int64_t a_minute_;
  std::int64_t row_ = 0;
  std::int64_t count_ = 0;
  std::array<std::int64_t, kMaxOverrunsAMinute + 1> lost_ns_{};
};

}  // namespace monitor::rt
