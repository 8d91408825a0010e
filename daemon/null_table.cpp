#include "daemon/null_table.h"

#include <fmt/format.h>

#include <cmath>
#include <ostream>

#include "daemon/rt/loop.h"

namespace monitor {
namespace {

using control::Action;
using control::GuardKind;

constexpr double kNever = hal::kMissing;
constexpr const char* kHolds = "D/A holds; permit/watchdog needed";

/// A device with its own thread may deliver a reading that is one period old.
double reading_s(const NullTableInputs& inputs) { return inputs.sample_time_s; }

/// Time from the onset of a guard's condition to its action.
double notice_s(const control::GuardConfig& guard, const NullTableInputs& inputs) {
  const double period_s = inputs.sample_time_s;
  switch (guard.which()) {
    case GuardKind::missing:
    case GuardKind::bus_lost:
      return static_cast<double>(inputs.max_bad_in_a_row + 1) * period_s;
    case GuardKind::stale:
      return guard.age_s + guard.time_s + 2.0 * period_s;
    case GuardKind::frozen:
      return guard.time_s + 2.0 * period_s;
    default:
      return guard.time_s + (guard.time_s > 0.0 ? 2.0 : 1.0) * period_s;
  }
}

NullRow guard_row(const control::GuardConfig& guard, const NullTableInputs& inputs) {
  NullRow row{"guard " + guard.id, kNever, ""};
  const double time_s = reading_s(inputs) + notice_s(guard, inputs) + inputs.times.latency_s;
  switch (control::action_of(guard.action)) {
    case Action::none:
    case Action::indicate:
      row.note = "indicates only";
      break;
    case Action::hold:
      row.note = "reference held";
      break;
    case Action::ramp:
      row.time_s = time_s + inputs.ramp_s + inputs.sample_time_s;
      break;
    case Action::disarm:
    case Action::latch:
      row.time_s = time_s;
      break;
  }
  return row;
}

NullRow left_alone(const char* failure, double time_s, const NullTableInputs& inputs) {
  NullRow row{failure, std::isfinite(time_s) ? time_s : kNever, ""};
  if (std::isnan(row.time_s)) row.note = inputs.has_permit ? "the permit's relay" : kHolds;
  return row;
}

}  // namespace

std::vector<NullRow> null_rows(const NullTableInputs& inputs) {
  const double period_s = inputs.sample_time_s;
  const double latency_s = inputs.times.latency_s;
  const double null_after_s = static_cast<double>(rt::kNullAfter_ns) * 1e-9;
  const hal::NullTimes& times = inputs.times;
  std::vector<NullRow> rows{
      {"stop, signal or error", 2.0 * period_s + latency_s, ""},
      {"position missing", reading_s(inputs) + period_s + latency_s, ""},
      // After an outage below 50 ms the controller resumes, after a longer one null is written.
      {"loop late, then back", null_after_s + period_s + latency_s, ""},
      left_alone("bus lost", times.bus_lost_s, inputs),
      left_alone("process killed", times.process_dead_s, inputs),
      left_alone(
          "process stopped",
          std::isnan(times.process_stopped_s) ? times.process_dead_s : times.process_stopped_s,
          inputs)};
  if (inputs.reading_hold_s > 0.0) {
    rows.push_back({"readings stop", inputs.reading_hold_s + 2.0 * period_s + latency_s, ""});
  }
  if (inputs.has_enable)
    rows.push_back({"enable lost", reading_s(inputs) + period_s + latency_s, ""});
  for (const control::GuardConfig& guard : inputs.guards) {
    const GuardKind kind = guard.which();
    // These guards never determine the time: null is written at the first missing reading, or
    // never.
    if (kind == GuardKind::missing || kind == GuardKind::bus_lost) continue;
    if (kind == GuardKind::e_stop && !inputs.has_e_stop) continue;
    rows.push_back(guard_row(guard, inputs));
  }
  return rows;
}

void print_null_table(const NullTableInputs& inputs, std::ostream& out) {
  out << fmt::format("# {:24} {:8} {:>16} {:>18}\n", "failure", "valve", "worst time (ms)",
                     "worst travel (mm)");
  for (const NullRow& row : null_rows(inputs)) {
    const bool never = std::isnan(row.time_s);
    const std::string time = never ? "never" : fmt::format("{:.1f}", row.time_s * 1e3);
    const double travel_mm = row.time_s * inputs.speed_mps * 1e3;
    const std::string travel = std::isnan(travel_mm) ? "-" : fmt::format("{:.2f}", travel_mm);
    const std::string note = never ? "  (" + row.note + ")" : "";
    out << fmt::format("# {:24} {:8} {:>16} {:>18}{}\n", row.failure, inputs.backend, time, travel,
                       note);
  }
}

}  // namespace monitor
