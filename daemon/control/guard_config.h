// The configuration of the guards: what is monitored, within which limits, with which action. One
// [[guard]] each:
//
//   kind       trips when                                              keys
//   travel     the rod is beyond a limit, or would be after braking    low_m, high_m, braking_mps2
//   following  |r - y| > limit_m                                       limit_m
//   speed      |dy/dt| > limit_mps                                     limit_mps
//   stale      the reading is older than age_s, or flagged stale without a known age      age_s
//   frozen     y moves less than least_m while |u - null| > command_V  least_m, command_V
//   jump       |dy| > limit_m in one period                            limit_m
//   saturated  the command is at a limit                               -
//   disagree   rod sensors differ by more than tolerance_m (position_voter.h)  tolerance_m
//   pressure   in RUN the measured pressure of `channel` is outside    channel, low_Pa, high_Pa
//   chambers   in RUN a chamber pressure is above the supply, or below 0, by more than tolerance_Pa
//                                                                      tolerance_Pa
//   transducer the pressure of `channel` cannot be read                channel
//   overrun    more periods are lost than [loop] allows                -
//   missing    more positions missing in a row than [loop] allows      -
//   bus_lost   more writes failed in a row than [loop] allows          -
//   e_stop     an input of that role is anything but 1, or cannot be read for longer than [loop]
//              allows of missing positions (null is written meanwhile)  -
//
// `time_s`: minimum duration (travel to disagree, not jump). The last four exist without an entry
// too, with the action latch (overrun: `[loop] overrun_action`).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "config/schema/visitor.h"
#include "daemon/control/failover.h"

namespace monitor::control {

/// The actions of a tripped guard, weakest first.
///
///   indicate  an alarm, nothing else
///   hold      the reference is frozen at the present position; the controller stays active
///   ramp      the command falls linearly to null over ramp_s, then DISARMED
///   disarm    null at once, DISARMED
///   latch     null at once, LATCHED
enum class Action : std::uint8_t { none, indicate, hold, ramp, disarm, latch };

[[nodiscard]] constexpr const char* to_string(Action action) noexcept {
  constexpr const char* kTexts[] = {"none", "indicate", "hold", "ramp", "disarm", "latch"};
  return kTexts[static_cast<std::size_t>(action)];
}

/// Action::none for an unknown name.
[[nodiscard]] constexpr Action action_of(std::string_view name) noexcept {
  for (const Action action :
       {Action::indicate, Action::hold, Action::ramp, Action::disarm, Action::latch}) {
    if (name == to_string(action)) return action;
  }
  return Action::none;
}

enum class GuardKind : std::uint8_t {
  e_stop,
  missing,
  bus_lost,
  overrun,
  travel,
  following,
  speed,
  stale,
  frozen,
  jump,
  saturated,
  disagree,
  pressure,
  chambers,
  transducer
};

/// Built-in guards, which need no entry: e_stop, missing, bus_lost, overrun.
inline constexpr std::size_t kBuiltIn = 4;
inline constexpr std::size_t kMaxGuards = 32;

[[nodiscard]] const char* to_string(GuardKind kind) noexcept;

struct GuardConfig {
  std::string id;  ///< empty: the kind's name
  std::string kind;
  std::string action = "latch";
  double time_s = 0.0;
  double low_m = -std::numeric_limits<double>::infinity();
  double high_m = std::numeric_limits<double>::infinity();
  double braking_mps2 = std::numeric_limits<double>::infinity();
  double limit_m = std::numeric_limits<double>::quiet_NaN();
  double limit_mps = std::numeric_limits<double>::quiet_NaN();
  double age_s = std::numeric_limits<double>::quiet_NaN();
  double least_m = std::numeric_limits<double>::quiet_NaN();
  double command_V = std::numeric_limits<double>::quiet_NaN();
  double tolerance_m = std::numeric_limits<double>::quiet_NaN();
  std::string channel;  ///< supply_pressure, pressure_in or pressure_out, as the role of an input
  double low_Pa = -std::numeric_limits<double>::infinity();
  double high_Pa = std::numeric_limits<double>::infinity();
  double tolerance_Pa = std::numeric_limits<double>::quiet_NaN();
  std::string guidance;  ///< advice to the operator; empty: the kind's default

  /// Visits only the keys of the chosen kind.
  void visit(config::schema::Visitor& v);
  [[nodiscard]] GuardKind which() const noexcept;
};

/// TOML [safety], [failover] and [[guard]].
struct SafetyConfig {
  double ramp_s = 0.2;      ///< duration of the action ramp
  double blend_s = 1.0;     ///< from the rod's position to the reference signal
  double blend_mps = 0.05;  ///< speed limit of the reference until it meets the signal
  FailoverConfig failover;
  std::vector<GuardConfig> guards;

  void visit(config::schema::Visitor& v);
};

/// All guards: the built-in ones in the order of GuardKind, then the others as listed. Throws
/// config::schema::Error for duplicate ids, duplicates of a built-in kind and too many guards.
[[nodiscard]] std::vector<GuardConfig> all_guards(const SafetyConfig& config,
                                                  Action overrun_action);

/// Default alarm text of a guard: the cause and advice to the operator.
[[nodiscard]] const char* reason_of(GuardKind kind) noexcept;
[[nodiscard]] const char* guidance_of(GuardKind kind) noexcept;

}  // namespace monitor::control
