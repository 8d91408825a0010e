// Quality of a value by the time since a device thread read it.
#pragma once

#include <cstdint>

namespace hal {

inline constexpr std::int64_t kStalePeriods = 3;
inline constexpr std::int64_t kBadPeriods = 6;

/// Good, stale after three periods of the loop, bad (no value) after six: the thread hangs, and a
/// switch may have moved since.
inline config::signals::Quality freshness(std::int64_t age_ns, std::int64_t period_ns) noexcept {
  if (age_ns > kBadPeriods * period_ns) return config::signals::Quality::bad;
  return age_ns > kStalePeriods * period_ns ? config::signals::Quality::stale
                                            : config::signals::Quality::good;
}

/// Longest age at which such a reading still counts.
[[nodiscard]] inline double reading_hold_s(double period_s) noexcept {
  return static_cast<double>(kBadPeriods) * period_s;
}

}  // namespace hal
