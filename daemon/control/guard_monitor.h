// Watches one tick's inputs against all guards and says what they lead to. Pure: no device, no
// thread; after construction nothing allocates.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "daemon/control/guard_config.h"

namespace monitor::control {

/// What is known at a tick, before its command is written. NaN: not known.
struct GuardInputs {
  double t_s = 0.0;  ///< on the loop's grid
  double y_m = std::numeric_limits<double>::quiet_NaN();
  double age_s = 0.0;  ///< of y
  bool called_stale = false;
  double reference_m = std::numeric_limits<double>::quiet_NaN();  ///< where y shall be, in RUN
  double command_V = 0.0;           ///< u - null of the period that ends now
  bool saturated = false;           ///< that command was at a limit
  double spare_difference_m = 0.0;  ///< of the rod sensors, PositionVoter::difference_m()
  bool other_sensor = false;        ///< y is another sensor's than in the tick before
};

/// The reading before this one.
class LastReading {
 public:
  /// NaN when there is none to compare with.
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

/// Whether that kind watches a reading, and not the motion.
[[nodiscard]] constexpr bool watches_a_sensor(GuardKind kind) noexcept {
  return kind == GuardKind::stale || kind == GuardKind::frozen || kind == GuardKind::jump;
}

/// Which guard asks for what; guard -1: none does.
struct GuardTrip {
  Action action = Action::none;
  int guard = -1;
};

/// One guard: its configuration and what it remembers.
class Guard {
 public:
  explicit Guard(const GuardConfig& config);

  /// Measured guards. `dy_m` since the last good reading, `dt_s` (> 0) ago; NaN when there is none.
  void watch(const GuardInputs& inputs, double dy_m, double dt_s, double period_s) noexcept;
  /// Those that others detect.
  void set(bool active, double value) noexcept;
  /// A motion begins at y: what lasted starts anew; a rod outside its travel may come back.
  void start(double y_m) noexcept;

  [[nodiscard]] GuardKind kind() const noexcept { return kind_; }
  [[nodiscard]] Action action() const noexcept { return action_; }
  [[nodiscard]] bool active() const noexcept { return active_; }
  /// Became active in the last call.
  [[nodiscard]] bool rose() const noexcept { return rose_; }
  /// What was compared with the limit last.
  [[nodiscard]] double value() const noexcept { return value_; }
  /// How long what it watches has lasted, frozen or not yet.
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
  double time_s_, low_, high_, braking_mps2_, least_m_, command_V_;
  double low_now_m_, high_now_m_;  ///< of travel, wider while the rod comes back
  double since_s_ = std::numeric_limits<double>::quiet_NaN();
  double anchor_m_ = 0.0;  ///< of frozen: where y stood at since_s_
  double sign_ = 0.0;      ///< of frozen: of the command since then
  double value_ = std::numeric_limits<double>::quiet_NaN();
  bool active_ = false;
  bool rose_ = false;
};

class SensorWatch;

class GuardMonitor {
 public:
  /// `guards` from all_guards().
  GuardMonitor(const std::vector<GuardConfig>& guards, double sample_time_s);

  /// A built-in guard, as another detected it. Its action if it is active.
  GuardTrip set(GuardKind built_in, bool active, double value) noexcept;
  /// All other guards. The strongest action among those that have just become active.
  /// `sensor`: watches the reading already, so that its guards' states are taken over; null: it is
  /// watched here.
  GuardTrip watch(const GuardInputs& inputs, const SensorWatch* sensor = nullptr) noexcept;
  /// A motion begins at y_m.
  void start(double y_m) noexcept;
  /// An active guard that forbids to arm and to start (e_stop, missing, bus_lost, stale, disagree,
  /// if they do more than indicate), or -1.
  [[nodiscard]] int obstacle() const noexcept;

  [[nodiscard]] const std::vector<Guard>& guards() const noexcept { return guards_; }

 private:
  std::vector<Guard> guards_;
  double sample_time_s_;
  LastReading last_;
};

}  // namespace monitor::control
