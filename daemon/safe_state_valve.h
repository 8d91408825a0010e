// Makes null the last command however the process ends: on leaving the scope and from a handler for
// every signal that would end the process.
#pragma once

#include <atomic>

#include "hal/device.h"

namespace monitor {

/// Wraps the valve that the loop drives. After close(), a late command of another thread is
/// followed by null again. One instance at a time.
class SafeStateValve final : public hal::ValveDrive {
 public:
  /// `valve` may be null and must outlive this object.
  explicit SafeStateValve(hal::ValveDrive* valve) noexcept;
  ~SafeStateValve() override;
  SafeStateValve(const SafeStateValve&) = delete;
  SafeStateValve& operator=(const SafeStateValve&) = delete;

  /// The drive to hand to the loop; null without a valve.
  [[nodiscard]] hal::ValveDrive* valve() noexcept { return valve_ == nullptr ? nullptr : this; }
  /// Commands null now and after every later command.
  void close() noexcept;

  hal::Applied write(double u_V, const hal::Tick& tick) noexcept override;
  hal::Applied go_null() noexcept override;
  hal::Applied end_at_null() noexcept override;

 private:
  hal::ValveDrive* valve_;
  std::atomic<bool> closed_{false};
};

/// Makes a write to a broken pipe or past a file-size limit return an error instead of ending the
/// process.
void ignore_write_signals() noexcept;

}  // namespace monitor
