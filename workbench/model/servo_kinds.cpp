#include <fmt/format.h>

#include <algorithm>

#include "workbench/model/kind_parts.h"
#include "workbench/model/kind_tables.h"

namespace workbench::model {
namespace {

using questions::kMust;

void servo(double full_mps, bool rotary, const Answers& a, ModelWriter& w) {
  const double gain = full_mps / a.at("full-command-V");
  add_notes(w, "velocity_servo",
            rotary ? "the command sets the speed; turning: y in rad"
                   : "the command sets the speed; there is no end of the stroke");
  w.begin("velocity_servo", rotary);
  w.value("gain_mps_per_V", gain, 0.1,
          fmt::format("full speed over {:g} V", a.at("full-command-V")));
  double lag_s = 1e-3 * a.at("lag-ms");
  if (valve_Hz(a) > 0.0) {
    lag_s = 1.0 / spool_rad_per_s(a);
    w.value("time_constant_s", lag_s, 0.3, "1 over the natural frequency: " + valve_words(a));
    w.value("damping_ratio", a.at("valve-damping"), 0.3, "a lag of second order");
  } else {
    w.value("time_constant_s", lag_s, lag_s > 0.0 ? 0.5 : kMust,
            lag_s > 0.0 ? "a guess within 50 %" : "");
  }
  w.start_of_references();
  w.loop(std::min(8.0, lag_s > 0.0 ? 0.25 / lag_s : 8.0) / gain);
}

void linear_servo(const Answers& a, ModelWriter& w) {
  servo(1e-3 * a.at("full-speed-mmps"), false, a, w);
}

void rotary_servo(const Answers& a, ModelWriter& w) {
  servo(a.at("full-speed-rpm") * 2.0 * kPi / 60.0, true, a, w);
}

/// Questions of both servos; they differ in that about the speed at full command.
std::vector<Question> servo_questions(const Question& full_speed) {
  const Question lag{"lag-ms",
                     "time constant of the speed behind the command",
                     "drive's step response, to 63 %; 0 is none",
                     0.0,
                     1e4,
                     10.0};
  const Question valve{"valve-Hz",
                       "-3 dB frequency of the speed, of a lag of second order",
                       "valve's Bode plot at small amplitude; takes the place of lag-ms, 0 is none",
                       0.0,
                       1e4,
                       0.0};
  const Question damping{"valve-damping",
                         "damping ratio of that lag",
                         "from the Bode plot; 0.7 to 1 is usual",
                         0.1,
                         5.0,
                         0.8};
  const Question full{"full-command-V",
                      "command of full speed",
                      "drive's set-up; 100 where the record has %",
                      0.001,
                      1000.0,
                      10.0};
  return {full_speed, full, lag, valve, damping, valve_step_question()};
}

}  // namespace

std::vector<Kind> servo_kinds() {
  return {{"velocity-servo", "axis whose command sets the speed; nothing else is known",
           servo_questions({"full-speed-mmps", "speed at full command", "drive's set-up, or a try",
                            1e-3, 1e5, kMust}),
           linear_servo},
          {"rotary-servo", "turning axis whose command sets the speed; nothing else is known",
           servo_questions({"full-speed-rpm", "speed at full command", "drive's set-up, or a try",
                            1e-3, 1e6, kMust}),
           rotary_servo}};
}

}  // namespace workbench::model
