// The control loop: once a period it reads the rod, decides, writes the valve and hands the sample
// on. Row k: y is read at t_k, before u_k is written; u_k holds until the next write.
//
// Null (valve.null_V) is written whenever the state is not RUN, in the first tick after 50 ms or
// more without one, and when the position is missing. Trips lead to LATCHED: too many overruns,
// readings missing or writes failed too many times in a row.
#pragma once

#include <cstdint>
#include <string>

#include "config/schema/visitor.h"
#include "daemon/control/arming.h"
#include "daemon/control/controller.h"
#include "daemon/control/reference_kinds.h"
#include "daemon/rt/clock.h"
#include "daemon/rt/grid.h"
#include "daemon/rt/loop_stats.h"
#include "daemon/rt/overrun.h"
#include "daemon/rt/queues.h"
#include "hal/device.h"

namespace monitor::rt {

/// TOML [loop].
struct LoopConfig {
  double rate_Hz = 200.0;
  bool auto_arm = false;
  std::int64_t max_lost_in_a_row = 10;
  std::int64_t max_lost_a_minute = 100;
  std::string overrun_action = "latch";
  std::int64_t max_bad_in_a_row = 3;
  std::string privileges = "try";
  std::int64_t priority = 80;
  std::int64_t cpu = -1;

  void visit(config::schema::Visitor& v);
};

/// After this long without a tick the old law is not trusted with the state it finds.
inline constexpr std::int64_t kNullAfter_ns = 50'000'000;

class Loop {
 public:
  /// What the loop works with; all of it outlives the loop. `valve` null: nothing is ever written
  /// and the state is MONITOR.
  struct Parts {
    Clock& clock;
    hal::RodSensor& rod;
    hal::ValveDrive* valve;
    const control::Reference& reference;
    SampleQueue& samples;
    CommandQueue& commands;
    LoopStats& stats;
  };

  Loop(const LoopConfig& config, const Parts& parts, const control::Controller& controller,
       double sample_time_s) noexcept;

  /// One period. False when the device has nothing more to give (end of a record). Does not
  /// allocate, lock, log or throw.
  bool tick(const Period& period) noexcept;

  /// The next tick writes null, whatever commands may say, and so do all after it.
  void close() noexcept { closing_ = true; }

 private:
  enum class OverrunAction : std::uint8_t { count, disarm, latch };

  void take_commands() noexcept;
  void apply(control::Event event) noexcept;
  void trip(Trip why) noexcept;
  /// From RUN or ARMED to DISARMED.
  void leave() noexcept;
  void watch_overruns(const Period& period) noexcept;
  void watch_device(bool good, std::int64_t& bad_in_a_row, Trip why) noexcept;
  void drive(const Period& period, bool have_position, estimator::fdi::Sample& sample) noexcept;
  void send(estimator::fdi::Sample& sample) noexcept;

  Parts parts_;
  control::Controller controller_;
  control::Sine commanded_{0.0, 0.0, 0.0};
  const control::Reference* reference_;
  control::Arming arming_;
  OverrunRule overruns_;
  OverrunAction overrun_action_;
  double sample_time_s_;
  std::int64_t max_bad_in_a_row_;
  bool closing_ = false;
  std::int64_t bad_readings_ = 0;
  std::int64_t bad_writes_ = 0;
  std::int64_t tick_ = 0;         ///< index of this tick
  std::int64_t motion_tick_ = 0;  ///< index at which the reference signal began
  std::int64_t gap_ = 0;          ///< periods that the detector has not been given
};

}  // namespace monitor::rt
