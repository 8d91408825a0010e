// Overrun limit: more than `in_a_row` periods lost without a good tick in between, or more than
// `a_minute` periods lost within 60 s. Fixed memory.
#pragma once

#include <array>
#include <cstdint>

namespace monitor::rt {

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
