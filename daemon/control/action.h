// The actions of a tripped guard, weakest first.
//
//   indicate  an alarm, nothing else
//   hold      the reference is frozen at the present position; the controller stays active
//   ramp      the command falls linearly to null over ramp_s, then DISARMED
//   disarm    null at once, DISARMED
//   latch     null at once, LATCHED
#pragma once

#include <cstdint>
#include <string_view>

namespace monitor::control {

enum class Action : std::uint8_t { none, indicate, hold, ramp, disarm, latch };

[[nodiscard]] constexpr const char* to_string(Action action) noexcept {
  switch (action) {
    case Action::none:
      return "none";
    case Action::indicate:
      return "indicate";
    case Action::hold:
      return "hold";
    case Action::ramp:
      return "ramp";
    case Action::disarm:
      return "disarm";
    case Action::latch:
      return "latch";
  }
  return "";
}

/// Action::none for an unknown name.
[[nodiscard]] constexpr Action action_of(std::string_view name) noexcept {
  for (const Action action :
       {Action::indicate, Action::hold, Action::ramp, Action::disarm, Action::latch}) {
    if (name == to_string(action)) return action;
  }
  return Action::none;
}

}  // namespace monitor::control
