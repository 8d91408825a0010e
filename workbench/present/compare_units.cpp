#include "workbench/present/compare_units.h"
#include "config/units/quantity.h"

#include <fmt/format.h>

#include <cmath>

namespace workbench::present {
namespace {

constexpr double kLongAgo_s = 1000.0;

/// Bounds are round numbers, or a record's extremes, where digits matter little but those of a late
/// time.
std::string bound(double value, const DisplayUnit& unit) {
  if (unit.text == "s" && std::abs(value) >= kLongAgo_s) return fmt::format("{:.1f}", value);
  return fmt::format("{:.4g}", std::abs(value) < 1e-12 ? 0.0 : unit.factor * value);
}

}  // namespace

DisplayUnit unit_of(const std::string& variable) {
  using config::units::axis_unit;
  if (variable == "y") return {"position", axis_unit("mm"), 1e3};
  if (variable == "v") return {"velocity", axis_unit("mm/s"), 1e3};
  if (variable == "speed") return {"speed", axis_unit("mm/s"), 1e3};
  if (variable == "u") return {"command", "V", 1.0};
  if (variable == "acceleration") return {"acceleration", axis_unit("m/s2"), 1.0};
  if (variable == "time") return {"time", "s", 1.0};
  return {"direction", "", 1.0};
}

std::string percent(double share) {
  if (!std::isfinite(share)) return "-";
  if (share > 0.0 && share < 0.01) return "under 1 %";
  if (share < 1.0 && share > 0.995) return "over 99 %";
  return fmt::format("{:.0f} %", 100.0 * share);
}

std::string bin_text(const std::string& variable, const validation::Bin& bin) {
  if (!bin.name.empty()) return config::units::axis_words(bin.name);
  const DisplayUnit unit = unit_of(variable);
  return bound(bin.from, unit) + " to " + bound(bin.to, unit);
}

std::string where(const validation::RegionRange& range) {
  using config::units::axis_words;
  if (!range.name.empty()) {
    return range.name == "at rest" ? range.name : "while " + config::units::axis_words(range.name);
  }
  const DisplayUnit unit = unit_of(range.variable);
  const std::string low = bound(range.from, unit);
  const std::string high = bound(range.to, unit);
  const std::string tail = std::string(" ") + unit.text;
  if (range.variable == "time") {
    if (range.lowest) return "in the first " + high + tail;
    return "from " + low + " to " + high + tail;
  }
  if (range.variable == "v") {
    if (range.highest && range.from > 0.0) {
      return axis_words("extending") + " faster than " + low + tail;
    }
    if (range.lowest && range.to < 0.0) {
      return axis_words("retracting") + " faster than " + bound(-range.to, unit) + tail;
    }
  }
  const bool plain = range.variable == "speed";
  const std::string head = plain
                               ? std::string()
                               : std::string("at ") + (range.variable == "v"   ? "velocities "
                                                       : range.variable == "y" ? "positions "
                                                       : range.variable == "u" ? "commands "
                                                                               : "accelerations ");
  if (range.lowest) return head + "below " + high + tail;
  if (range.highest) return head + "above " + low + tail;
  return head + (plain ? "between " : "from ") + low + (plain ? " and " : " to ") + high + tail;
}

std::string where(const validation::SignificantRegion& failing) {
  std::string text;
  for (const validation::RegionRange& range : failing.ranges)
    text += (text.empty() ? "" : " ") + where(range);
  return text;
}

}  // namespace workbench::present
