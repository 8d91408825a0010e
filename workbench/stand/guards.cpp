// The questions about a stand's guards, and the [[guard]] tables that follow.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "workbench/stand/answers.h"
#include "workbench/stand/tables.h"

namespace workbench::stand {
namespace {

using questions::kMust;

/// Distance that a proportional loop stays behind the sine: peak speed over the loop's rate.
double lag_mm(const Answers& a) {
  const double peak_mmps =
      2.0 * std::numbers::pi * a.number("frequency-Hz") * a.number("amplitude-mm");
  const double rate_per_s =
      a.number("gain-V-per-m") * a.number("max-speed-mmps") / 1e3 / a.number("limit-V");
  return rate_per_s > 0.0 ? peak_mmps / rate_per_s : HUGE_VAL;
}

std::vector<StandQuestion> pressure_guards() {
  const auto supply = [](const Answers& a) { return a.driven() && a.measures_supply(); };
  const char* gauge = "gauge at the manifold, relief valve's setting";
  return {
      {{"supply-low-bar", "lowest supply pressure to run with", gauge, 0.0, 9000.0, kMust},
       supply,
       nullptr},
      {{"supply-high-bar", "highest supply pressure to run with", gauge, 0.1, 1e4, kMust},
       supply,
       nullptr},
      {{"chamber-tolerance-bar", "excess of a chamber over the supply that no circuit has",
        "transducers' sheets: their errors added up", 0.001, 1e4, 10.0},
       [](const Answers& a) { return a.driven() && a.measures_chambers(); },
       nullptr},
  };
}

void guard(TomlWriter& w, const char* kind, const char* comment) {
  w.item("guard", comment);
  w.text("kind", kind);
}

void pressure_guards(TomlWriter& w, const Answers& a) {
  if (!a.measures_supply()) return;
  guard(w, "pressure", "supply pressure outside its limits, in RUN");
  w.text("channel", "supply_pressure");
  w.asked("low_Pa", a.number("supply-low-bar") * 1e5, "supply-low-bar");
  w.asked("high_Pa", a.number("supply-high-bar") * 1e5, "supply-high-bar");
  w.text("action", "ramp");
  for (const char* channel : {"supply_pressure", "pressure_in", "pressure_out"}) {
    if (std::string(channel) != "supply_pressure" && !a.measures_chambers()) continue;
    guard(w, "transducer", "a pressure that cannot be read");
    w.text("id", "transducer_" + std::string(channel));
    w.text("channel", channel);
    w.text("action", "indicate");
  }
  if (!a.measures_chambers()) return;
  guard(w, "chambers", "pressures that contradict each other");
  w.asked("tolerance_Pa", a.number("chamber-tolerance-bar") * 1e5, "chamber-tolerance-bar");
  w.text("action", "ramp");
}

}  // namespace

std::vector<StandQuestion> guard_questions() {
  std::vector<StandQuestion> all{
      {{"speed-limit-mmps", "speed that trips", "test plan; at most the fastest speed", 0.001, 1e5,
        0.0},
       &Answers::driven,
       [](const Answers& a) { return 0.7 * a.number("max-speed-mmps"); }},
      {{"braking-mps2", "deceleration that is certain at null",
        "force that holds over moving mass, "
        "a good part less; `inf` of the file: not counted",
        0.001, 1e6, 20.0},
       &Answers::driven,
       nullptr},
      {{"jump-mm", "step of the reading in one period that no motion has",
        "more than the speed that trips over the rate", 1e-4, 1e5, 0.0},
       &Answers::driven,
       [](const Answers& a) {
         return std::max(1.0, 2.0 * a.number("speed-limit-mmps") / a.number("rate-Hz"));
       }},
      {{"following-mm", "distance between reference and position that trips",
        "twice the lag of the controller", 1e-4, 1e5, 0.0},
       &Answers::driven,
       [](const Answers& a) {
         const double travel_mm = a.number("high-mm") - a.number("low-mm");
         return std::min(std::max(1.0, 2.0 * lag_mm(a)), std::max(1.0, travel_mm));
       }},
      {{"frozen-mm", "motion under which a reading counts as frozen",
        "some steps of the position sensor", 1e-4, 1e5, 0.1},
       &Answers::driven,
       nullptr},
      {{"frozen-V", "distance of the command from null that must move the rod",
        "more than the valve's dead band, which commissioning measures", 0.001, 99.0, 0.0},
       &Answers::driven,
       [](const Answers& a) { return 0.05 * a.number("limit-V"); }},
  };
  const std::vector<StandQuestion> pressures = pressure_guards();
  all.insert(all.end(), pressures.begin(), pressures.end());
  return all;
}

void write_guards(TomlWriter& w, const Answers& a) {
  if (!a.driven()) return;
  const auto metres = [&](const char* flag) { return a.number(flag) / 1e3; };
  w.heading(
      "Guards: indicate (alarm only), hold (reference frozen), ramp (to null, DISARMED), latch "
      "(null at once)");
  guard(w, "travel", "counts where the rod would stop; start again to return");
  w.asked("low_m", metres("low-mm"), "low-mm");
  w.asked("high_m", metres("high-mm"), "high-mm");
  w.asked("braking_mps2", a.number("braking-mps2"), "braking-mps2");
  w.text("action", "hold");
  guard(w, "speed", "faster than any test asks for");
  w.asked("limit_mps", metres("speed-limit-mmps"), "speed-limit-mmps");
  w.text("action", "latch");
  guard(w, "jump", "a reading that leaps");
  w.asked("limit_m", metres("jump-mm"), "jump-mm");
  w.text("action", "latch");
  guard(w, "following", "the rod does not follow");
  w.asked("limit_m", metres("following-mm"), "following-mm");
  w.number("time_s", 0.1, "shorter trips at every start");
  w.text("action", "ramp");
  guard(w, "frozen", "a reading that stands still under a command");
  w.asked("least_m", metres("frozen-mm"), "frozen-mm");
  w.asked("command_V", a.number("frozen-V"), "frozen-V");
  w.number("time_s", 0.2, "longer than the valve's dead time");
  w.text("action", "ramp");
  pressure_guards(w, a);
}

}  // namespace workbench::stand
