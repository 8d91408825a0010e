// Counters and state published by the loop, and the detector's progress. One writer each, any
// reader.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>

#include "daemon/control/arming.h"
#include "daemon/control/failover.h"
#include "daemon/rt/guard_status.h"
#include "hal/histogram.h"

namespace monitor::rt {

/// Why the state is LATCHED; `guard`: a configured [[guard]].
enum class Trip : std::uint8_t { none, overrun, reading, write, e_stop, e_stop_unread, guard };

inline constexpr std::size_t kMaxSpareRods = control::kMaxRods - 1;
inline constexpr std::size_t kMaxInputs = 16;

/// A counter with one writer.
class Counter {
 public:
  void add(std::int64_t n = 1) noexcept { value_.store(value() + n, std::memory_order_relaxed); }
  [[nodiscard]] std::int64_t value() const noexcept {
    return value_.load(std::memory_order_relaxed);
  }

 private:
  std::atomic<std::int64_t> value_{0};
};

/// Read statistics of a device.
struct DeviceStats {
  Counter good, bad;
  std::atomic<double> value{
      std::numeric_limits<double>::quiet_NaN()};  ///< newest reading, NaN: none

  void count(bool is_good, double reading) noexcept {
    (is_good ? good : bad).add();
    value.store(is_good ? reading : std::numeric_limits<double>::quiet_NaN(),
                std::memory_order_relaxed);
  }
};

/// A rod sensor's state in the voter; the configured sensor is the first.
struct RodStats {
  std::atomic<control::RodFault> fault{control::RodFault::none};  ///< why the sensor is out
  std::atomic<std::int64_t> since_tick{0};  ///< tick of the last change of `fault`
};

struct LoopStats {
  Counter ticks;
  Counter overruns;  ///< late wake-ups that skipped periods
  Counter skipped_periods;
  Counter dropped_samples;  ///< queue to the detector full
  Counter expired_commands;
  Counter rejected_commands;  ///< not allowed in the current state
  DeviceStats rod;            ///< the configured sensor
  Counter valve_good, valve_bad;
  Counter permit_good, permit_bad;  ///< toggles of the permit output
  std::array<DeviceStats, kMaxSpareRods> spare_rods;
  std::array<DeviceStats, kMaxInputs> inputs;
  std::array<RodStats, control::kMaxRods> rods;
  std::atomic<std::uint8_t> rod_in_charge{0};
  std::atomic<std::int64_t> rod_since_tick{0};  ///< when the sensor in charge took over
  hal::Histogram lateness, read, control, write, tick;
  std::atomic<control::ArmingState> state{control::ArmingState::disarmed};
  std::atomic<Trip> trip{Trip::none};
  std::atomic<std::uint8_t> trip_guard{0};  ///< index of the guard that tripped
  std::atomic<bool> holding{false};         ///< RUN, with the reference frozen
  std::atomic<bool> ramping{false};         ///< RUN, on the way to null
  std::atomic<double> y_m{std::numeric_limits<double>::quiet_NaN()};
  std::atomic<double> reference_m{std::numeric_limits<double>::quiet_NaN()};
  std::atomic<double> u_V{std::numeric_limits<double>::quiet_NaN()};
  std::atomic<std::uint64_t> answer{0};  ///< to the newest command: control::unpack
  GuardStatus guards;
  Counter detected_samples;                    ///< fully processed by the detector
  std::atomic<std::int32_t> active_alarms{0};  ///< written by the detector once a second
};

}  // namespace monitor::rt
