// A servo in closed form, for the commissioning procedure; truth is what it is made of.
//
//   y' = v,   v' = (gain dead_zone(sign u(t - delay) + valve.null_V - null) - v) / lag
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <random>

#include "daemon/control/commissioning.h"

namespace monitor::control::commissioning_test {

constexpr double kTs_s = 0.005;
constexpr double kStep_s = 1e-4;

struct Servo {
  double gain_mps_per_V = 0.045;
  double null_V = 0.0;  ///< counted from the commanded one
  double dead_zone_V = 0.0;
  double delay_s = 0.008;
  double lag_s = 0.01;
  double noise_m = 2e-6;
  double count_m = 5e-6;  ///< the encoder's step, 0: none
  double valve_sign = 1.0;
  double encoder_sign = 1.0;
  double stop_low_m = -1e9;
  double stop_high_m = 1e9;
  double push_mps = 0.0;    ///< whatever the command
  double down_ratio = 1.0;  ///< gain downward over gain upward

  double y_m = 0.3;
  double v_mps = 0.0;
  bool dead_sensor = false;
  bool stuck = false;
  bool no_value = false;
  double index_m = 1e9;  ///< seen once y is above
  double lost = 0.0;     ///< probability that this and three more commands never arrive

  // ---
  double t_s = 0.0;
  double farthest_m = 0.0;  ///< true travel from `from_m`
  double from_m = 0.3;
  double highest_V = 0.0;
  std::deque<double> line{};
  std::mt19937 random{7};
  double last_reading_m = 0.3;
  double held_V = 0.0;
  int losing = 0;
  bool disturbed = false;

  /// The command as it reaches the valve: the one before when it is lost.
  double deliver(double u_V) {
    if (losing == 0 && lost > 0.0 && std::bernoulli_distribution(lost)(random)) losing = 4;
    disturbed = losing > 0;
    if (disturbed) --losing;
    return held_V = disturbed ? held_V : u_V;
  }
  void hold(double u_V, double duration_s) {
    highest_V = std::max(highest_V, std::abs(u_V));
    for (int n = static_cast<int>(std::lround(duration_s / kStep_s)); n > 0; --n) {
      line.push_back(u_V);
      double at_valve_V = 0.0;
      if (static_cast<double>(line.size()) > delay_s / kStep_s) {
        at_valve_V = line.front();
        line.pop_front();
      }
      const double x = valve_sign * at_valve_V - null_V;
      const double half = 0.5 * dead_zone_V;
      const double open = x > half ? x - half : x < -half ? x + half : 0.0;
      const double gain = gain_mps_per_V * (open < 0.0 ? down_ratio : 1.0);
      const double asked = stuck ? 0.0 : gain * open + push_mps;
      // Exact over the step: v decays to what is asked.
      const double decay = std::exp(-kStep_s / lag_s);
      y_m += asked * kStep_s + (v_mps - asked) * lag_s * (1.0 - decay);
      v_mps = asked + (v_mps - asked) * decay;
      y_m = std::clamp(y_m, stop_low_m, stop_high_m);
      farthest_m = std::max(farthest_m, std::abs(y_m - from_m));
    }
    t_s += duration_s;
  }
  double read() {
    if (dead_sensor) return last_reading_m;
    std::normal_distribution<double> noise(0.0, noise_m);
    const double y = encoder_sign * y_m + noise(random);
    return last_reading_m = count_m > 0.0 ? count_m * std::round(y / count_m) : y;
  }
};

/// One tick of the procedure; the servo holds what it says for a period.
inline void tick(Commissioning& procedure, Servo& servo) {
  Commissioning::Input in;
  in.now_s = in.t_s = servo.t_s;
  in.usable = !servo.no_value;
  in.y_m = servo.read();
  in.homed = servo.y_m > servo.index_m;
  in.disturbed = servo.disturbed;
  servo.hold(servo.deliver(procedure.step(in)), kTs_s);
}

/// Until the stage is over; then the rod coasts for half a second at null.
inline void run(Commissioning& procedure, Servo& servo) {
  servo.from_m = servo.y_m;
  servo.farthest_m = 0.0;
  while (!procedure.over()) tick(procedure, servo);
  servo.hold(0.0, 0.5);
}

inline Failure up_to_sign(Commissioning& procedure, Servo& servo) {
  for (const Stage stage : {Stage::rest, Stage::sign}) {
    procedure.begin(stage);
    run(procedure, servo);
    if (procedure.failure() != Failure::none) break;
  }
  return procedure.failure();
}

inline Failure up_to_speeds(Commissioning& procedure, Servo& servo) {
  if (up_to_sign(procedure, servo) != Failure::none) return procedure.failure();
  procedure.begin(Stage::speeds);
  run(procedure, servo);
  return procedure.failure();
}

inline Servo with(double Servo::*what, double value) {
  Servo servo;
  servo.*what = value;
  return servo;
}

/// Noise of 2 um over a speed of at least 4 mm/s, extrapolated over 0.1 s: 0.5 ms; the lag's tail.
constexpr double kLatencyTolerance_s = 0.0015;

}  // namespace monitor::control::commissioning_test
