// The absolute time grid: period n begins at start + n * period. A wake-up that is late by a period
// or more skips whole periods and waits for the next grid point, so the phase is kept.
#pragma once

#include "daemon/rt/clock.h"
#include "hal/device.h"

namespace monitor::rt {

struct Period {
  hal::Tick tick;
  std::int64_t lateness_ns = 0;  ///< of the wake-up for this tick
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

}  // namespace monitor::rt
