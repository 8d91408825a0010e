// The loop's clock: the machine's monotonic clock, or a virtual clock that jumps to each wake-up
// time, so that the same code runs as fast as possible and deterministically.
#pragma once

#include <cstdint>

namespace monitor::rt {

class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual std::int64_t now_ns() const noexcept = 0;
  [[nodiscard]] virtual std::int64_t utc_us() const noexcept = 0;
  /// Returns immediately when the time has passed.
  virtual void sleep_until_ns(std::int64_t time_ns) noexcept = 0;
};

class MonotonicClock final : public Clock {
 public:
  [[nodiscard]] std::int64_t now_ns() const noexcept override;
  [[nodiscard]] std::int64_t utc_us() const noexcept override;
  void sleep_until_ns(std::int64_t time_ns) noexcept override;
};

/// Starts at 0, and so does its wall clock.
class VirtualClock final : public Clock {
 public:
  [[nodiscard]] std::int64_t now_ns() const noexcept override { return now_ns_; }
  [[nodiscard]] std::int64_t utc_us() const noexcept override { return now_ns_ / 1000; }
  void sleep_until_ns(std::int64_t time_ns) noexcept override {
    if (time_ns > now_ns_) now_ns_ = time_ns;
  }
  /// Simulates elapsed time.
  void advance_ns(std::int64_t duration_ns) noexcept { now_ns_ += duration_ns; }

 private:
  std::int64_t now_ns_ = 0;
};

}  // namespace monitor::rt
