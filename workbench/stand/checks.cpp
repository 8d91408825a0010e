// Answers that are each in their range and contradict each other. What one file of the daemon can
// contradict by itself (two quantities in one register, a line used twice) is left to its own
// check.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "config/schema/error.h"
#include "workbench/stand/answers.h"

namespace workbench::stand {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& allowed) {
  throw config::schema::UsageError(std::string(kPlace) + ": " + what + "; allowed: " + allowed);
}

/// Throws unless a < b.
void require_below(const Answers& a, const char* low, const char* high) {
  if (std::isnan(a.number(low)) || a.number(low) < a.number(high)) return;
  refuse(fmt::format("--{} is {:g}", high, a.number(high)),
         fmt::format("more than --{} {:g}", low, a.number(low)));
}

/// Farthest that a travel guard counts a sine, y + v |v| / (2 b): the amplitude, unless the motion
/// decelerates harder than the braking b.
double counted_reach_mm(const Answers& a) {
  const double amplitude_mm = a.number("amplitude-mm");
  const double braking_mmps2 = 1e3 * a.number("braking-mps2");
  const double w_rad_per_s = 2.0 * std::numbers::pi * a.number("frequency-Hz");
  const double peak_mmps2 = amplitude_mm * w_rad_per_s * w_rad_per_s;
  if (!(peak_mmps2 > braking_mmps2)) return amplitude_mm;  // also where no braking was asked
  const double peak_mmps = amplitude_mm * w_rad_per_s;
  return braking_mmps2 / (2.0 * w_rad_per_s * w_rad_per_s) +
         peak_mmps * peak_mmps / (2.0 * braking_mmps2);
}

void check_motion(const Answers& a) {
  const double centre = a.number("centre-mm");
  const double amplitude = a.number("amplitude-mm");
  const double low = a.number("low-mm");
  const double high = a.number("high-mm");
  if (centre < low || centre > high) {
    refuse(fmt::format("--centre-mm is {:g}", centre), fmt::format("{:g} to {:g}", low, high));
  }
  const double room = std::min(centre - low, high - centre);
  if (amplitude > room) {
    refuse(fmt::format("--amplitude-mm is {:g}, beyond the travel", amplitude),
           fmt::format("0 to {:g} about --centre-mm {:g}", room, centre));
  }
  if (const double reach = counted_reach_mm(a); reach > room) {
    refuse(fmt::format("--amplitude-mm {:g} at --frequency-Hz {:g}, beyond the travel: position "
                       "and braking distance come to {:.4g} mm",
                       amplitude, a.number("frequency-Hz"), reach),
           fmt::format("up to {:g} mm about --centre-mm {:g}", room, centre));
  }
  const double speed = a.number("speed-limit-mmps");
  const double peak = 2.0 * std::numbers::pi * a.number("frequency-Hz") * amplitude;
  if (peak > speed) {
    refuse(fmt::format("--amplitude-mm {:g} at --frequency-Hz {:g} moves at {:.4g} mm/s", amplitude,
                       a.number("frequency-Hz"), peak),
           fmt::format("up to --speed-limit-mmps {:g}", speed));
  }
}

void check_guards(const Answers& a) {
  const double speed = a.number("speed-limit-mmps");
  if (speed > a.number("max-speed-mmps")) {
    refuse(fmt::format("--speed-limit-mmps is {:g}, which the rod never reaches", speed),
           fmt::format("up to --max-speed-mmps {:g}", a.number("max-speed-mmps")));
  }
  const double step = speed / a.number("rate-Hz");
  if (a.number("jump-mm") <= step) {
    refuse(fmt::format("--jump-mm is {:g}, and the rod may move as far in one period",
                       a.number("jump-mm")),
           fmt::format("more than {:.4g}", step));
  }
  if (a.number("frozen-V") >= a.number("limit-V")) {
    refuse(fmt::format("--frozen-V is {:g}, which no command exceeds", a.number("frozen-V")),
           fmt::format("less than --limit-V {:g}", a.number("limit-V")));
  }
}

struct Reach {
  double low, high, step;
};

/// The numbers that a register of that type can hold, in the unit of the scale.
Reach reach(const std::string& type, double scale, double offset) {
  const bool wide = type == "int32" || type == "uint32";
  const double span = std::ldexp(1.0, wide ? 32 : 16);
  const bool is_float = type == "float32";
  const double low = is_float ? -3.4e38 : type[0] == 'i' ? -span / 2.0 : 0.0;
  const double high = is_float ? 3.4e38 : low + span - 1.0;
  const double one = low * scale + offset;
  const double other = high * scale + offset;
  return {std::min(one, other), std::max(one, other), is_float ? 0.0 : std::abs(scale)};
}

void check_register(const Answers& a, const std::string& name, const char* scale,
                    const char* offset, double low, double high) {
  const std::string type = a.text(name + "-type");
  if (a.number(scale) == 0.0) refuse(std::string("--") + scale + " is 0", "any other number");
  const Reach found = reach(type, a.number(scale), a.number(offset));
  constexpr double kFewest = 20.0;  // steps: fewer, and no loop can work with them
  if (found.step * kFewest > high - low) {
    refuse(
        fmt::format("--{} is {:g}, too coarse for {:g} to {:g}", scale, a.number(scale), low, high),
        fmt::format("up to {:g} in magnitude", (high - low) / kFewest));
  }
  if (found.low <= low && found.high >= high) return;
  refuse(fmt::format("--{}-type {} with --{} {:g} reaches from {:.5g} to {:.5g}", name, type, scale,
                     a.number(scale), found.low, found.high),
         fmt::format("a type, scale and offset that reach from {:g} to {:g}", low, high));
}

void check_modbus(const Answers& a) {
  if (!a.modbus()) return;
  require_below(a, "sensor-low-mm", "sensor-high-mm");
  if (a.number("sensor-low-mm") > a.number("low-mm")) {
    refuse(fmt::format("--sensor-low-mm is {:g}, inside the travel", a.number("sensor-low-mm")),
           fmt::format("up to --low-mm {:g}", a.number("low-mm")));
  }
  if (a.number("sensor-high-mm") < a.number("high-mm")) {
    refuse(fmt::format("--sensor-high-mm is {:g}, inside the travel", a.number("sensor-high-mm")),
           fmt::format("--high-mm {:g} or more", a.number("high-mm")));
  }
  check_register(a, "position", "position-mm-per-count", "position-offset-mm", a.number("low-mm"),
                 a.number("high-mm"));
  if (a.number("pressure-bar-per-count") == 0.0) {
    refuse("--pressure-bar-per-count is 0", "any other number");
  }
  if (a.number("command-V-per-count") == 0.0) {
    refuse("--command-V-per-count is 0", "any other number");
  }
  if (!a.driven()) return;
  check_register(a, "command", "command-V-per-count", "command-offset-V",
                 a.number("null-V") - a.number("limit-V"),
                 a.number("null-V") + a.number("limit-V"));
  const double periods_ms = 2000.0 / a.number("rate-Hz");
  const double watchdog_ms = a.number("watchdog-ms");
  if (watchdog_ms > 0.0 && watchdog_ms < periods_ms) {
    refuse(fmt::format("--watchdog-ms is {:g}, less than two periods", watchdog_ms),
           fmt::format("0 (none), or {:g} to 60000", periods_ms));
  }
}

void check_board(const Answers& a) {
  if (!a.comedi()) return;
  for (const char* flag : {"pressure-bar-per-V", "command-V-per-V"}) {
    if (a.number(flag) == 0.0) refuse(std::string("--") + flag + " is 0", "any other number");
  }
}

void check_simulated(const Answers& a) {
  if (!a.sim()) return;
  const double most_V = std::abs(a.number("null-V")) + a.number("limit-V");
  if (a.number("dac-range-V") < most_V) {
    refuse(fmt::format("--dac-range-V is {:g}", a.number("dac-range-V")),
           fmt::format("{:g} or more, for null and limit", most_V));
  }
}

void check_watchdog(const Answers& a) {
  if (!a.is("accept-no-watchdog", "no")) return;
  refuse("nothing takes a command away when this process dies",
         std::string(a.modbus() ? "--watchdog-ms (the device's time-out), --permit-register"
                                : "--permit-line") +
             " (a watchdog relay), or --accept-no-watchdog yes");
}

}  // namespace

void check_answers(const Answers& a) {
  require_below(a, "low-mm", "high-mm");
  if (!a.text("model").empty() && !std::filesystem::is_regular_file(a.text("model"))) {
    refuse("--model is \"" + a.text("model") + "\", which is no file", "a model file (TOML)");
  }
  check_modbus(a);
  check_board(a);
  if (!a.driven()) return;
  check_motion(a);
  check_guards(a);
  check_simulated(a);
  require_below(a, "supply-low-bar", "supply-high-bar");
  check_watchdog(a);
}

}  // namespace workbench::stand
