// One tick of the loop as the fault detection sees it: a plain value that passes through lock-free
// queues.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "config/signals/pressures.h"
#include "config/signals/quality.h"

namespace config::signals {

/// Rod sensors that a sample has room for.
inline constexpr std::size_t kMaxRods = 5;

constexpr std::array<double, kMaxRods> no_rods() noexcept {
  std::array<double, kMaxRods> none{};
  for (double& y_m : none) y_m = std::numeric_limits<double>::quiet_NaN();
  return none;
}

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

  // Where the rig has several rod sensors, each of them, the configured one first.
  std::uint8_t rod_count = 0;      ///< 0: there is one alone, and y_m is its reading
  std::uint8_t rod_in_charge = 0;  ///< whose reading y_m is
  bool rod_changed = false;        ///< another than in the sample before: y_m may have a step here
  std::int64_t rod_since = 0;      ///< tick from which on it has been in charge
  std::array<double, kMaxRods> rod_m = no_rods();
  std::array<Quality, kMaxRods> rod_quality{};
  std::array<std::uint8_t, kMaxRods> rod_fault{};  ///< why it is out, as in rods_t; 0: it is in

  Pressures pressures;
};
static_assert(std::is_trivially_copyable_v<Sample>);

}  // namespace config::signals
