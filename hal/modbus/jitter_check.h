// Checks that readings arrive once per period and at a constant phase. A reading with another
// phase, or a repeated one, gives a past position of the rod but not that at the tick.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace hal::modbus {

class JitterCheck {
 public:
  explicit JitterCheck(std::int64_t tolerance_ns) noexcept : tolerance_ns_(tolerance_ns) {}

  /// For a reading measured at t_ns in the tick at nominal_ns. Call once per tick.
  bool accepts(std::int64_t t_ns, std::int64_t nominal_ns) noexcept {
    if (t_ns == last_t_ns_) return false;
    last_t_ns_ = t_ns;
    const std::int64_t phase_ns = t_ns - nominal_ns;
    const std::int64_t off_ns = phase_ns - usual_ns_;
    usual_ns_ += std::clamp(off_ns, -tolerance_ns_, tolerance_ns_) / kSlowness;
    off_ = std::abs(off_ns) <= tolerance_ns_ ? 0 : off_ + 1;
    if (off_ < kNewHabit) return off_ == 0;
    usual_ns_ = phase_ns;
    off_ = 0;
    return true;
  }

 private:
  static constexpr std::int64_t kSlowness = 16;
  static constexpr int kNewHabit =
      5;  ///< readings in a row at another phase that make it the usual one

  std::int64_t tolerance_ns_;
  std::int64_t last_t_ns_ = 0;
  std::int64_t usual_ns_ = 0;
  int off_ = kNewHabit;  ///< the first reading sets the phase
};

}  // namespace hal::modbus
