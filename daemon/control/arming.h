// Arming: whether the controller may drive the valve. Pure state machine: no time, no device.
//
//   MONITOR    nothing is ever written (no valve, or a replayed record); no event leaves this state
//   DISARMED   null is written                      arm -> ARMED
//   ARMED      null is written                      start -> RUN, disarm -> DISARMED
//   RUN        the controller drives                   stop -> ARMED, disarm -> DISARMED
//   LATCHED    null is written, after a trip        reset -> DISARMED
//
// A trip leads from every state but MONITOR to LATCHED.
#pragma once

#include <cstdint>

namespace monitor::control {

enum class ArmingState : std::uint8_t { monitor, disarmed, armed, run, latched };
enum class Event : std::uint8_t { arm, disarm, start, stop, reset, trip };

class Arming {
 public:
  explicit Arming(bool monitor_only) noexcept
      : state_(monitor_only ? ArmingState::monitor : ArmingState::disarmed) {}

  [[nodiscard]] ArmingState state() const noexcept { return state_; }
  /// Returns whether the event was allowed in the current state.
  bool apply(Event event) noexcept;

 private:
  ArmingState state_;
};

}  // namespace monitor::control
