// Whatever way the process ends, null is the last command: on leaving the scope, and from a handler
// of every signal that would end the process.
#pragma once

#include <atomic>

#include "hal/device.h"

namespace monitor {

/// The valve as the loop drives it. Once null has been commanded for good, another thread's command
/// that comes after it is followed by null again. One guard at a time.
class SafeStateValve final : public hal::ValveDrive {
 public:
  /// `valve` may be null and must outlive the guard.
  explicit SafeStateValve(hal::ValveDrive* valve) noexcept;
  ~SafeStateValve() override;
  SafeStateValve(const SafeStateValve&) = delete;
  SafeStateValve& operator=(const SafeStateValve&) = delete;

  /// What the loop shall drive, null when there is no valve.
  [[nodiscard]] hal::ValveDrive* valve() noexcept { return valve_ == nullptr ? nullptr : this; }
  /// Null, now and after every later command.
  void close() noexcept;

  hal::Applied write(double u_V, const hal::Tick& tick) noexcept override;
  hal::Applied go_null() noexcept override;
  hal::Applied end_at_null() noexcept override;

 private:
  hal::ValveDrive* valve_;
  std::atomic<bool> closed_{false};
};

/// A write to a broken pipe or past a file-size limit returns an error and ends nothing.
void outlive_failed_writes() noexcept;

}  // namespace monitor
