// One tick of the loop as the fault detection sees it: a plain value that passes through lock-free
// queues.
#pragma once

#include <cstdint>
#include <type_traits>

namespace estimator::fdi {

enum class Quality : std::uint8_t { good = 0, uncertain = 1, stale = 2, bad = 3 };

/// y_m is read at t_read_ns, before u_applied_V is written at t_write_ns; u holds until the next
/// write. A missing number is NaN.
struct Sample {
  std::int64_t tick = 0;  ///< number of the period on the absolute grid
  std::int64_t t_read_ns = 0;
  std::int64_t t_write_ns = 0;
  std::int64_t utc_us = 0;
  double reference_m = 0.0;
  double y_m = 0.0;
  double u_requested_V = 0.0;
  double u_applied_V = 0.0;
  Quality quality = Quality::good;
  std::uint8_t state = 0;  ///< arming state, as in sample_t
  bool saturated = false;  ///< a limit of range or slew was active
  std::int32_t gap = 0;    ///< periods missing just before this one
};
static_assert(std::is_trivially_copyable_v<Sample>);

}  // namespace estimator::fdi
