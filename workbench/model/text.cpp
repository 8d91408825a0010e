// The sheet as text and as JSON.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "config/units/quantity.h"
#include "plant_sim/library.h"
#include "workbench/model/sheet.h"
#include "workbench/present/json.h"
#include "workbench/present/printed_axis.h"

namespace workbench::model {
namespace {

using nlohmann::ordered_json;
using present::number_or_null;
namespace units = config::units;

std::string si_words(const std::string& name, double value) {
  if (!std::isfinite(value)) return "";
  const std::string unit = units::axis_unit(units::unit_of(name));
  return fmt::format("{:.6g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::string value_words(const std::string& name, double value) {
  return units::words(units::quantity(name, value, std::nan("")));
}

std::string prior_words(const SheetParameter& p) {
  if (!p.fitted) return "held";
  if (!std::isfinite(p.prior_ratio)) return "fitted, no prior";
  return fmt::format("fitted, +-{:.3g} %", 100.0 * p.prior_ratio);
}

std::string lines(const std::vector<SheetParameter>& parameters, bool fits) {
  std::string text;
  for (const SheetParameter& p : parameters) {
    if (!fits && std::isnan(p.value)) continue;
    text += fmt::format("  {:<40} {:<16} {:<24} {:<8} {:<18} {}\n", p.name,
                        value_words(p.name, p.value), si_words(p.name, p.value),
                        to_string(p.source), fits ? prior_words(p) : "", units::axis_words(p.what));
  }
  return text;
}

/// "to 40 kg at 10 s, over 2 s".
std::string change_words(const plant_sim::Change& change) {
  std::string text = std::isnan(change.value) ? fmt::format("times {:.6g}", change.factor)
                                              : "to " + value_words(change.parameter, change.value);
  text += fmt::format(" at {:.6g} s", change.at_s);
  if (change.time_constant_s > 0.0) {
    return text + ", time constant " + value_words("time_s", change.time_constant_s);
  }
  return change.ramp_s > 0.0 ? text + ", over " + value_words("time_s", change.ramp_s) : text;
}

std::string lines(const std::vector<plant_sim::Change>& changes) {
  std::string text;
  for (const plant_sim::Change& change : changes) {
    text += fmt::format("  {:<40} {}\n", change.parameter, change_words(change));
  }
  return text;
}

ordered_json json_of(const std::vector<plant_sim::Change>& changes) {
  ordered_json out = ordered_json::array();
  for (const plant_sim::Change& change : changes) {
    out.push_back({{"parameter", change.parameter},
                   {"at_s", change.at_s},
                   {"value", number_or_null(change.value)},
                   {"factor", number_or_null(change.factor)},
                   {"ramp_s", change.ramp_s},
                   {"time_constant_s", change.time_constant_s}});
  }
  return out;
}

ordered_json json_of(const std::vector<SheetParameter>& parameters) {
  ordered_json out = ordered_json::array();
  for (const SheetParameter& p : parameters) {
    out.push_back({{"name", p.name},
                   {"what", p.what},
                   {"value", number_or_null(p.value)},
                   {"unit", units::axis_unit(units::unit_of(p.name))},
                   {"min", number_or_null(p.min)},
                   {"max", number_or_null(p.max)},
                   {"source", to_string(p.source)},
                   {"fitted", p.fitted},
                   {"prior_ratio", number_or_null(p.prior_ratio)}});
  }
  return out;
}

}  // namespace

std::string to_text(const Sheet& sheet) {
  const plant_sim::ModelFile& model = sheet.model;
  const present::PrintedAxis axis(present::motion_of(model));
  std::string text =
      fmt::format("{}: {}, {}, step {}\n\n", model.name, model.plant,
                  model.rotary() ? "rotary" : "linear", value_words("step_s", model.step_s));
  text += fmt::format("  {:<40} {:<16} {:<24} {:<8} {:<18} {}\n", "parameter", "value", "SI",
                      "from", "in a fit", "meaning");
  text += lines(sheet.plant, true);
  if (!sheet.effects.empty()) text += "\n" + lines(sheet.effects, true);
  text += "\n" + lines(sheet.initial, false);
  text += fmt::format("  {:<40} {}\n", "loop.kp_V_per_m",
                      value_words("kp_V_per_m", model.loop.kp_V_per_m));
  if (!model.changes.empty()) {
    text += "\nChanges within its record, after which the rest of this sheet does not hold:\n" +
            lines(model.changes);
  }
  text += "\nWhat follows, to hold beside the data sheets:\n";
  for (const DerivedQuantity& d : sheet.derived) {
    const std::string value = std::isnan(d.value) ? "never steady" : value_words(d.name, d.value);
    text += fmt::format("  {:<62} {}\n", units::axis_words(d.what), value);
  }
  if (!sheet.held_scale.empty()) text += "\n" + sheet.held_scale + "\n";
  return text;
}

std::string to_json(const Sheet& sheet) {
  const plant_sim::ModelFile& model = sheet.model;
  const present::PrintedAxis axis(present::motion_of(model));
  ordered_json out;
  out["name"] = model.name;
  out["plant"] = model.plant;
  out["motion"] = model.rotary() ? "rotary" : "linear";
  out["step_s"] = number_or_null(model.step_s);
  out["parameters"] = json_of(sheet.plant);
  out["effects"] = json_of(sheet.effects);
  out["initial"] = json_of(sheet.initial);
  out["kp_V_per_m"] = number_or_null(model.loop.kp_V_per_m);
  out["changes"] = json_of(model.changes);
  out["derived"] = ordered_json::array();
  for (const DerivedQuantity& d : sheet.derived) {
    out["derived"].push_back({{"name", d.name},
                              {"what", d.what},
                              {"value", number_or_null(d.value)},
                              {"unit", units::axis_unit(units::unit_of(d.name))}});
  }
  out["held"] = sheet.held_scale.empty() ? ordered_json(nullptr) : ordered_json(sheet.held_scale);
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace workbench::model
