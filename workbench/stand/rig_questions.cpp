// Questions that every stand is asked: devices, travel, valve, motion; and those of the simulated
// one.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "workbench/stand/answers.h"

namespace workbench::stand {
namespace {

using questions::kMust;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

std::vector<StandQuestion> device_questions() {
  const Question simulated = questions::text_question(
      "model", "model file of the rig", "config/models, or made by `spoolwatch new KIND`");
  Question healthy = simulated;
  healthy.where = "made by `spoolwatch new KIND` or fitted, for `promote`; empty: none yet";
  healthy.may_be_empty = true;
  return {
      {questions::choice_question(
           "backend", "what reads the position and drives the valve",
           "sim: simulated in the daemon; modbus: TCP or RTU; comedi: encoder on GPIO lines and "
           "a comedi board",
           {"sim", "modbus", "comedi"}, ""),
       nullptr, nullptr},
      {questions::choice_question(
           "valve", "who drives the valve",
           "driven: this daemon; watched: the controller that is there, nothing is ever written",
           {"driven", "watched"}, "driven"),
       [](const Answers& a) { return a.modbus() || a.comedi(); }, nullptr},
      {questions::choice_question(
           "runs-as", "where logs, alarms and socket go",
           "desk: beside the file; service: /var/lib/spoolwatch and /run/spoolwatch",
           {"desk", "service"}, "desk"),
       nullptr, nullptr},
      {simulated, [](const Answers& a) { return a.sim(); }, nullptr},
      {healthy, [](const Answers& a) { return a.modbus() || a.comedi(); }, nullptr},
      {questions::choice_question("pressures", "measured pressures",
                                  "hydraulic circuit: none; supply; all: supply and "
                                  "both chambers",
                                  {"none", "supply", "all"}, "none"),
       nullptr, nullptr},
  };
}

std::vector<StandQuestion> travel_questions() {
  return {
      {{"rate-Hz", "rate of the control loop",
        "device manual: no device updates slower; simulated: whole steps of the model", 1.0, 2000.0,
        200.0},
       nullptr,
       nullptr},
      {{"low-mm", "lowest position that the rod may have",
        "drawing of the rig: inside the stop, the fixture and the specimen", -1e5, 9.9e4, kMust},
       nullptr,
       nullptr},
      {{"high-mm", "highest position that the rod may have", "the same drawing, other end", -9.9e4,
        1e5, kMust},
       nullptr,
       nullptr},
      {{"max-speed-mmps", "fastest that the rod can move at the limit of the command",
        "rated flow over piston area: `spoolwatch show MODEL` prints it", 0.01, 1e5, kMust},
       nullptr,
       nullptr},
  };
}

std::vector<StandQuestion> valve_questions() {
  return {
      {{"null-V", "command at which the rod rests",
        "valve's test sheet, null bias; commissioning "
        "measures it",
        -100.0, 100.0, 0.0},
       &Answers::driven,
       nullptr},
      {{"limit-V", "greatest distance of a command from null",
        "valve electronics' sheet, full command", 0.01, 100.0, 10.0},
       &Answers::driven,
       nullptr},
      {{"slew-V-per-s", "fastest change of the command",
        "valve electronics' sheet, or what the "
        "specimen bears",
        0.001, 1e9, 1000.0},
       &Answers::driven,
       nullptr},
  };
}

/// Speed of the loop where nobody says otherwise, 1/s: slow enough for any valve.
constexpr double kLoop_per_s = 5.0;

std::vector<StandQuestion> motion_questions() {
  return {
      {{"gain-V-per-m", "gain of the position controller",
        "5 1/s times limit over fastest speed to begin with; twice that is too much for slow "
        "valves",
        0.0, 1e6, 0.0},
       &Answers::driven,
       [](const Answers& a) {
         return kLoop_per_s * a.number("limit-V") / (a.number("max-speed-mmps") / 1e3);
       }},
      {{"frequency-Hz", "frequency of the sine that `start` begins", "test plan", 0.0, 1000.0, 0.5},
       &Answers::driven,
       nullptr},
      {{"centre-mm", "middle of the motion", "test plan; inside the travel", -1e5, 1e5, 0.0},
       &Answers::driven,
       [](const Answers& a) { return 0.5 * (a.number("low-mm") + a.number("high-mm")); }},
      {{"amplitude-mm", "amplitude of the motion", "test plan; small to begin with", 0.0, 1e5, 0.0},
       &Answers::driven,
       [](const Answers& a) {
         const double rate_per_s = kTwoPi * a.number("frequency-Hz");
         const double tenth_mm = 0.1 * (a.number("high-mm") - a.number("low-mm"));
         const double slow_mm = 0.2 * a.number("max-speed-mmps") / rate_per_s;
         return rate_per_s > 0.0 ? std::min(tenth_mm, slow_mm) : tenth_mm;
       }},
  };
}

}  // namespace

std::vector<StandQuestion> rig_questions() {
  std::vector<StandQuestion> all = device_questions();
  for (const auto& part : {travel_questions(), valve_questions(), motion_questions()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

std::vector<StandQuestion> simulated_questions() {
  const auto sim = [](const Answers& a) { return a.sim(); };
  const char* group = "Simulated stand";
  return {
      {{"encoder-um", "step of the simulated encoder", "0: none", 0.0, 1e5, 5.0},
       sim,
       nullptr,
       group},
      {{"noise-um", "standard deviation of its reading", "0: none", 0.0, 1e5, 2.0},
       sim,
       nullptr,
       group},
      {questions::whole_question("dac-bits", "resolution of the simulated D/A converter", "0: none",
                                 0.0, 24.0, 12.0),
       sim, nullptr, group},
      {{"dac-range-V", "range of that converter, both ways", "must hold null and limit", 0.01,
        1000.0, 10.0},
       sim,
       nullptr,
       group},
  };
}

}  // namespace workbench::stand
