// The control loop: once a period it reads the rod sensors and the auxiliary inputs, runs the state
// machine and the controller, writes the valve and queues the sample. Row k: y is read at t_k,
// before u_k is written; u_k holds until the next write.
//
// Null (valve.null_V) is written whenever the state is not RUN (a stop is null at once), in the
// first tick after 50 ms or more without one, and when the position is missing. Guards (control/
// guard_monitor.h) hold the reference, ramp the command to null or latch; losing the enable input
// disarms. A start begins at the rod's position; a start while a guard holds resumes from there,
// and so does the controller after an intermediate null.
//
// control/position_voter.h selects among several rod sensors.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "daemon/control/arming.h"
#include "daemon/control/controller.h"
#include "daemon/control/guard_monitor.h"
#include "daemon/control/reference_generator.h"
#include "daemon/control/reject_reason.h"
#include "daemon/rt/auxiliary_inputs.h"
#include "daemon/rt/clock.h"
#include "daemon/rt/grid.h"
#include "daemon/rt/loop_stats.h"
#include "daemon/rt/queues.h"
#include "daemon/rt/redundant_position_sensor.h"
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
  [[nodiscard]] control::Action overrun() const noexcept;
};

/// Limits on driving the valve.
struct SafetyRules {
  control::SafetyConfig safety;
  bool may_arm = true;  ///< false: no valid calibration
};

/// After an outage this long the controller does not resume with its old state.
inline constexpr std::int64_t kNullAfter_ns = 50'000'000;

class Loop {
 public:
  /// Collaborators; must outlive the loop. `valve` null: nothing is ever written and the state is
  /// MONITOR.
  struct Parts {
    Clock& clock;
    hal::RodSensor& rod;
    hal::ValveDrive* valve;
    const control::Reference& reference;
    SampleQueue& samples;
    CommandQueue& commands;
    LoopStats& stats;
    const std::vector<hal::NamedRod>* spare_rods = nullptr;
    const std::vector<hal::NamedInput>* inputs = nullptr;
    hal::Output* permit = nullptr;
  };

  /// Throws config::schema::Error for contradictory guards.
  Loop(const LoopConfig& config, const Parts& parts, const control::Controller& controller,
       double sample_time_s, const SafetyRules& rules = {});

  /// Runs one period. Returns false at the end of a record. Does not allocate, lock, log or throw.
  bool tick(const Period& period) noexcept;

  /// From the next tick on, only null is written.
  void close() noexcept { closing_ = true; }

 private:
  void take_commands() noexcept;
  [[nodiscard]] control::RejectReason carry_out(const LoopCommand& command) noexcept;
  [[nodiscard]] control::RejectReason carry_out(control::Event event, bool at_once) noexcept;
  void take(GuardUpdate& update, bool expired) noexcept;
  /// Why arming or starting is forbidden.
  [[nodiscard]] control::RejectReason obstacle(control::Event event) const noexcept;
  void apply(control::Event event) noexcept;
  /// Applies a guard's action. `measured`: acts in RUN only.
  void act(const control::GuardTrip& trip, bool measured) noexcept;
  void latch(int guard) noexcept;
  void set_trip(int guard) noexcept;
  /// Goes from RUN or ARMED to DISARMED.
  void leave() noexcept;
  void watch_overruns(const Period& period) noexcept;
  /// Emergency stop, enable, missing positions.
  void watch_inputs(const hal::Tick& tick) noexcept;
  /// Evaluates the reference and the measuring guards.
  void watch_motion(const hal::Reading& reading, config::signals::Sample& sample) noexcept;
  void drive(const Period& period, config::signals::Sample& sample) noexcept;
  void send(config::signals::Sample& sample) noexcept;
  void publish_stats(const Period& period, const config::signals::Sample& sample) noexcept;
  [[nodiscard]] double time_s() const noexcept {
    return static_cast<double>(tick_) * sample_time_s_;
  }
  [[nodiscard]] bool have_position() const noexcept { return bad_readings_ == 0; }

  Parts parts_;
  control::Controller controller_;
  control::ReferenceGenerator reference_;
  control::Ramp ramp_;
  control::GuardMonitor guard_monitor_;
  control::Arming arming_;
  RedundantPositionSensor position_sensor_;
  AuxiliaryInputs aux_inputs_;
  OverrunRule overruns_;
  double sample_time_s_;
  double null_V_;
  std::int64_t max_bad_in_a_row_;
  bool may_arm_;
  control::CommandAnswer answer_;  ///< to the newest command, published at the end of the tick
  bool closing_ = false;
  bool permit_on_ = false;
  bool interrupted_ = false;   ///< in RUN, but the previous tick wrote null
  double y_m_ = 0.0;           ///< in this tick, NaN when missing
  double last_V_ = 0.0;        ///< u - null of the last command
  bool last_limited_ = false;  ///< the last command was at a limit
  std::int64_t bad_readings_ = 0;
  std::int64_t bad_writes_ = 0;
  /// Tick of a latch because something could not be read; -1: none.
  std::int64_t unread_latch_tick_ = -1;
  std::int64_t tick_ = 0;  ///< index of this tick
  std::int64_t gap_ = 0;   ///< periods missing from the sample queue
};

}  // namespace monitor::rt
