// Commissioning: short pulses of low authority that identify the wiring and the properties of valve
// and rod sensor. Pure: maps the reading of each tick to a command; no device, no thread; no
// allocation after construction.
//
// Model of the rig; u is the command relative to valve.null_V, positive extends:
//
//   y' = gain dead_zone(u - null) behind a delay and a lag
//
// Stages, each started by the caller, each ending at null:
//   rest     null: noise about a straight line, drift
//   sign     pulses up and down, doubled until the reading deviates from its line by 0.04 of
//            max_travel. The reading must rise with the command, otherwise the result is
//            `reversed`.
//   speeds   pulses in both directions at two speeds each. The line through speed and command of a
//            direction reaches zero speed at an end of the dead zone; null is the middle, gain the
//            mean slope. Latency: from a step to the intersection of the lines fitted to the
//            reading before and after it.
//   home     slowly to a stop (or until the sensor has seen its index), and a little back
//
// A disturbed measurement (a lost reply, a skipped period) is repeated.
// The rod stays within max_travel of the start of a stage (home: home_travel): a pulse ends after
// 0.45 of it at most, the next one goes back, and at 0.8 the stage is aborted; the rest is reserved
// for the rod to come to a stop. The stage is also aborted at a speed above max_speed, for motion
// against the command, for no motion at full authority, and without a fresh reading for max_gap.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "daemon/control/level_search.h"
#include "daemon/control/line_fit.h"

namespace monitor::control {

struct CommissioningLimits {
  double authority_V = 1.0;  ///< largest deviation of a command from null
  double max_travel_m = 5e-3;
  double max_speed_mps = 0.05;
  double home_travel_m = 1.0;
  double pulse_s = 0.2;  ///< 0.4 of it for settling, the rest for measuring
  double max_gap_s = 0.1;
  double most_s = 120.0;  ///< longest duration of a stage
};

enum class Stage : std::uint8_t { rest, sign, speeds, home };

enum class Failure : std::uint8_t {
  none,
  travel,
  speed,
  wrong_way,
  no_motion,
  no_reading,
  reversed,
  too_noisy,
  no_level,  ///< no command gives a measurable speed within the travel
  too_slow,  ///< the rod responds too late for such short pulses
  no_index,  ///< reached a stop first
  too_long
};

/// One line for people, without the figures.
[[nodiscard]] const char* to_string(Failure failure) noexcept;

/// Results; NaN until the stage has run.
struct Findings {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double noise_m = kNone;
  double drift_mps = kNone;  ///< at valve.null_V
  double sign_V = kNone;     ///< the command, relative to null, that revealed the sign
  double sign_m = kNone;     ///< the resulting change of the reading
  double null_V = kNone;     ///< from valve.null_V
  double dead_zone_V = kNone;
  double gain_mps_per_V = kNone;
  double latency_s = kNone;
  double home_m = kNone;
};

class Commissioning {
 public:
  explicit Commissioning(const CommissioningLimits& limits) noexcept;

  /// Order: rest, sign, speeds, home.
  void begin(Stage stage) noexcept;
  /// Drives toward the upper (1) or lower (-1) stop; `index`: until step() reports the index.
  void begin_home(int direction, bool index) noexcept;

  struct Input {
    double now_s = 0.0;  ///< time of this tick
    double t_s = 0.0;    ///< measurement time of y
    double y_m = 0.0;
    bool usable = false;  ///< y is present and not stale
    bool homed = false;   ///< the sensor has found its index
    /// A command or reading since the last tick may be lost: the measurement is repeated.
    bool disturbed = false;
    /// Command reported by the device, relative to valve.null_V; NaN when not reported.
    double applied_V = Findings::kNone;
  };
  /// The command to write, relative to valve.null_V; 0 once the stage is over.
  double step(const Input& in) noexcept;

  [[nodiscard]] bool over() const noexcept { return over_; }
  [[nodiscard]] Failure failure() const noexcept { return failure_; }
  [[nodiscard]] const Findings& findings() const noexcept { return findings_; }
  /// Speed of the faster pulses and of homing.
  [[nodiscard]] double target_mps() const noexcept { return target_mps_; }
  /// Rod travel in this stage.
  [[nodiscard]] double travel_m() const noexcept { return travel_m_; }
  [[nodiscard]] double speed_mps() const noexcept { return speed_mps_; }

 private:
  enum class Move : std::uint8_t { pause, pulse, drive };
  enum class Drive : std::uint8_t { back, home, back_off };

  /// One direction, up or down.
  struct Side {
    LevelSearch fast, slow;
    int found = 0;  ///< completed searches: fast, then slow
    /// Sums over the pulses with motion: command u, speed v.
    int points = 0;
    double u = 0.0, v = 0.0, uu = 0.0, uv = 0.0;
  };

  void fail(Failure failure) noexcept;
  void finish() noexcept;
  /// Checks the limits. Returns whether y is new.
  bool watch(const Input& in) noexcept;
  void start_pause(double now_s) noexcept;
  void start_pulse(double now_s, int direction, double level_V) noexcept;
  void start_drive(Drive what, double now_s, int direction, double level_V) noexcept;
  void pause_over(double now_s) noexcept;
  void pulse(const Input& in, bool fresh) noexcept;
  void sign_pulse_over(double now_s) noexcept;
  void speed_pulse_over(double now_s, bool too_far) noexcept;
  /// One secant step toward the command at which the rod stands still between pulses.
  void improve_rest() noexcept;
  /// Starts the next pulse of the stage speeds after a pause.
  void next_speed(double now_s) noexcept;
  void evaluate() noexcept;
  void drive(const Input& in) noexcept;
  [[nodiscard]] Side& side(int direction) noexcept { return sides_[direction > 0 ? 1 : 0]; }
  [[nodiscard]] bool wants(const Side& side) const noexcept {
    return side.found < 1 || (side.found < 2 && sides_[0].found > 0 && sides_[1].found > 0);
  }

  CommissioningLimits limits_;
  double target_mps_;  ///< speed of the faster pulses
  Findings findings_;
  Stage stage_ = Stage::rest;
  Move move_ = Move::pause;
  Drive drive_ = Drive::back;
  bool over_ = true;
  bool begun_ = false;  ///< the stage has had its first reading
  Failure failure_ = Failure::none;
  bool index_ = false;
  int home_direction_ = 1;
  int direction_ = 1;  ///< sign of this move's command
  double command_V_ = 0.0;
  double applied_V_ = 0.0;  ///< the same as far as is known
  double rest_V_ = 0.0;     ///< between pulses
  double sign_level_V_ = 0.0;
  int sign_first_ = 1;    ///< direction of the first pulse of each level
  double stage_s_ = 0.0;  ///< when the stage began
  double move_s_ = 0.0;   ///< when this move did
  double start_m_ = 0.0;  ///< where the rod was when the stage began
  double move_m_ = 0.0;   ///< and the move
  double last_m_ = 0.0;   ///< newest reading
  double last_t_s_ = 0.0;
  double still_s_ = 0.0;  ///< since when the rod has not moved in a drive; NaN: it moves
  double fresh_s_ = 0.0;  ///< tick of the last usable reading
  double travel_m_ = 0.0;
  double speed_mps_ = 0.0;
  LineFit before_, after_;
  std::array<Side, 2> sides_;
  double latency_sum_ = 0.0;  ///< sum of latency times weight
  double latency_weight_ = 0.0;
  /// Readings of the last periods, for the speed.
  static constexpr int kWindow = 8;
  std::array<double, kWindow> window_t_s_{}, window_m_{};
  int window_ = 0;
};

}  // namespace monitor::control
