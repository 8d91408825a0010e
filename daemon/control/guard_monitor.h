// Evaluates all guards once per tick and returns the action they demand. Pure: no device, no
// thread; no allocation after construction.
#pragma once

#include <limits>
#include <vector>

#include "config/signals/pressures.h"
#include "daemon/control/guard_config.h"

namespace monitor::control {

/// Inputs of one tick, before its command is written. NaN: unknown.
struct GuardInputs {
  double t_s = 0.0;  ///< on the loop's grid
  double y_m = std::numeric_limits<double>::quiet_NaN();
  double age_s = 0.0;  ///< age of y
  bool called_stale = false;
  double reference_m = std::numeric_limits<double>::quiet_NaN();  ///< in RUN
  double command_V = 0.0;           ///< u - null of the previous period
  bool saturated = false;           ///< the previous command was at a limit
  double spare_difference_m = 0.0;  ///< PositionVoter::difference_m()
  config::signals::Pressures pressures;
  bool other_sensor = false;  ///< the voter switched sensors since the previous tick
};

/// The previous good reading.
class LastReading {
 public:
  /// NaN without a previous reading.
  [[nodiscard]] double dy_m(const GuardInputs& inputs) const noexcept {
    return dt_s(inputs) > 0.0 ? inputs.y_m - y_m_ : std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] double dt_s(const GuardInputs& inputs) const noexcept { return inputs.t_s - t_s_; }
  void update(const GuardInputs& inputs) noexcept {
    if (!(inputs.y_m == inputs.y_m)) return;  // NaN
    y_m_ = inputs.y_m;
    t_s_ = inputs.t_s;
  }
  void forget() noexcept { y_m_ = std::numeric_limits<double>::quiet_NaN(); }

 private:
  double y_m_ = std::numeric_limits<double>::quiet_NaN();
  double t_s_ = 0.0;
};

/// True for a kind that monitors the sensor rather than the motion.
[[nodiscard]] constexpr bool watches_a_sensor(GuardKind kind) noexcept {
  return kind == GuardKind::stale || kind == GuardKind::frozen || kind == GuardKind::jump;
}

/// The demanded action and the index of the guard, -1 when there is none.
struct GuardTrip {
  Action action = Action::none;
  int guard = -1;
};

/// One guard: its configuration and state.
class Guard {
 public:
  explicit Guard(const GuardConfig& config);

  /// Evaluates a measured guard. `dy_m`: since the last good reading, `dt_s` (> 0) ago; NaN without
  /// one.
  void watch(const GuardInputs& inputs, double dy_m, double dt_s, double period_s) noexcept;
  /// Sets a guard that is detected elsewhere.
  void set(bool active, double value) noexcept;
  /// Takes the limits and times of `other`, a guard of the same kind; what is
  /// active or has lasted for some time stays so.
  void take_limits(const Guard& other) noexcept;
  /// A motion starts at y: timers restart; a rod outside its travel limits may return.
  void start(double y_m) noexcept;

  [[nodiscard]] GuardKind kind() const noexcept { return kind_; }
  [[nodiscard]] Action action() const noexcept { return action_; }
  [[nodiscard]] bool active() const noexcept { return active_; }
  /// True when the guard became active in the last call.
  [[nodiscard]] bool rose() const noexcept { return rose_; }
  /// The value last compared with the limit.
  [[nodiscard]] double value() const noexcept { return value_; }
  /// Duration of the condition so far.
  [[nodiscard]] double lasting_s(double t_s) const noexcept {
    return since_s_ == since_s_ ? t_s - since_s_ : 0.0;
  }
  [[nodiscard]] double time_s() const noexcept { return time_s_; }
  [[nodiscard]] double low() const noexcept { return low_; }
  [[nodiscard]] double high() const noexcept { return high_; }

 private:
  [[nodiscard]] bool outside_travel(double y_m, double speed_mps) noexcept;
  [[nodiscard]] bool frozen(const GuardInputs& inputs) noexcept;
  void lasts(bool condition, double t_s) noexcept;

  GuardKind kind_;
  Action action_;
  /// The channel that the guards `pressure` and `transducer` watch.
  double config::signals::Pressures::*channel_ = &config::signals::Pressures::supply_Pa;
  double time_s_, low_, high_, braking_mps2_, least_m_, command_V_;
  double low_now_m_, high_now_m_;  ///< travel limits, wider while the rod returns
  double since_s_ = std::numeric_limits<double>::quiet_NaN();
  double anchor_m_ = 0.0;  ///< frozen: y at since_s_
  double sign_ = 0.0;      ///< frozen: sign of the command since then
  double value_ = std::numeric_limits<double>::quiet_NaN();
  bool active_ = false;
  bool rose_ = false;
};

class SensorWatch;

class GuardMonitor {
 public:
  /// `guards` from all_guards().
  GuardMonitor(const std::vector<GuardConfig>& guards, double sample_time_s);

  /// Sets a built-in guard and returns its action if it is active.
  GuardTrip set(GuardKind built_in, bool active, double value) noexcept;
  /// Evaluates all other guards and returns the strongest action among those that just became
  /// active. `sensor`: has evaluated the sensor guards already, and its states are copied; null:
  /// they are evaluated here.
  GuardTrip watch(const GuardInputs& inputs, const SensorWatch* sensor = nullptr) noexcept;
  /// Takes the limits of `guards`, one for each of guards() in the same order.
  void take_limits(const std::vector<Guard>& guards) noexcept;
  /// A motion starts at y_m.
  void start(double y_m) noexcept;
  /// Index of an active guard that forbids arming and starting (e_stop, missing, bus_lost, stale,
  /// disagree, unless they only indicate), or -1.
  [[nodiscard]] int obstacle() const noexcept;

  [[nodiscard]] const std::vector<Guard>& guards() const noexcept { return guards_; }

 private:
  std::vector<Guard> guards_;
  double sample_time_s_;
  LastReading last_;
};

}  // namespace monitor::control
