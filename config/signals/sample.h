// One tick of the loop as input of the fault detection: trivially copyable, passed through
// lock-free queues.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "config/signals/pressures.h"
#include "config/signals/quality.h"

namespace config::signals {

/// Maximum number of rod sensors in a sample.
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

  // Individual readings of a rig with several rod sensors, the configured one first.
  std::uint8_t rod_count = 0;      ///< 0: a single sensor, whose reading is y_m
  std::uint8_t rod_in_charge = 0;  ///< index of the sensor that y_m comes from
  bool rod_changed = false;        ///< sensor changed since the previous sample: y_m may step here
  std::int64_t rod_since = 0;      ///< first tick with this sensor in charge
  std::array<double, kMaxRods> rod_m = no_rods();
  std::array<Quality, kMaxRods> rod_quality{};
  std::array<std::uint8_t, kMaxRods>
      rod_fault{};  ///< reason for exclusion, as in rods_t; 0: in use

  Pressures pressures;
};
static_assert(std::is_trivially_copyable_v<Sample>);

}  // namespace config::signals
