// Runs a loop from its first tick to the last, which commands null: in virtual time on the calling
// thread, in real time on its own threads. Both use the same steps.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include "daemon/rt/loop.h"
#include "daemon/rt/privileges.h"

namespace monitor::rt {

inline constexpr std::int64_t kForever = std::numeric_limits<std::int64_t>::max();

/// Takes the samples off the loop's queue, on a thread of its own; may throw.
class SampleConsumer {
 public:
  virtual ~SampleConsumer() = default;
  /// Handles all samples queued and whatever else is due.
  virtual void poll() = 0;
  /// Handles the last samples; poll() is not called again.
  virtual void finish() = 0;
};

/// Steps one loop. Null is the last command however the run ends.
class LoopRunner {
 public:
  /// `ticks`: periods before the closing one; `valve` may be null.
  LoopRunner(Loop& loop, const Grid& grid, Clock& clock, hal::ValveDrive* valve, std::int64_t ticks,
             const std::atomic<bool>& stop) noexcept
      : loop_(loop), grid_(grid), clock_(clock), valve_(valve), ticks_(ticks), stop_(stop) {}
  ~LoopRunner() {
    if (valve_ != nullptr) valve_->go_null();
  }
  LoopRunner(const LoopRunner&) = delete;
  LoopRunner& operator=(const LoopRunner&) = delete;

  /// Waits for the next period and runs it; false after the last.
  bool step() noexcept {
    const Period period = grid_.next(clock_);
    const bool last = stop_.load(std::memory_order_relaxed) || period.tick.index >= ticks_;
    if (last && valve_ == nullptr) return false;
    if (last) loop_.close();
    return loop_.tick(period) && !last;
  }

 private:
  Loop& loop_;
  Grid grid_;
  Clock& clock_;
  hal::ValveDrive* valve_;
  std::int64_t ticks_;
  const std::atomic<bool>& stop_;
};

/// Both return why the run failed, in one line; empty: success.
///
/// Polls `stop_asked` now and then; once it returns true, the next tick is the last.
std::string run_virtual(LoopRunner& runner, SampleConsumer& consumer, std::atomic<bool>& stop,
                        const std::function<bool()>& stop_asked);

/// `wait_stop_asked` waits up to 100 ms and returns whether to stop.
std::string run_realtime(LoopRunner& runner, SampleConsumer& consumer,
                         const hal::ThreadOptions& loop_thread, std::atomic<bool>& stop,
                         hal::ValveDrive* valve, const std::function<bool()>& wait_stop_asked);

}  // namespace monitor::rt
