#include "estimator/greybox/held_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "config/schema/joined.h"
#include "config/units/quantity.h"

namespace estimator::greybox {
namespace {

using Names = std::span<const std::string_view>;

constexpr std::array<std::string_view, 1> kAxisScale{"gain_N_per_V"};
constexpr std::array<std::string_view, 1> kActuatorScale{"area_m2"};
constexpr std::array<std::string_view, 2> kCylinderScale{"cap_area_m2", "rod_side_area_m2"};
// spool travel in metres stands for a flow on hydraulic_actuator; on hydraulic_cylinder the rated
// flow does, at a travel of its own
constexpr std::array<std::string_view, 7> kActuatorFlows{"valve_gain_m_per_V",
                                                         "dead_volume_m3",
                                                         "conductance_m3ps_per_Pa",
                                                         "limit_m3ps",
                                                         "rate_mps",
                                                         "retracted_cushion_orifice_m2",
                                                         "extended_cushion_orifice_m2"};
constexpr std::array<std::string_view, 7> kCylinderFlows{
    "rated_flow_m3ps",           "cap_dead_volume_m3", "rod_dead_volume_m3",
    "conductance_m3ps_per_Pa",   "limit_m3ps",         "retracted_cushion_flow_m3ps",
    "extended_cushion_flow_m3ps"};
constexpr std::array<std::string_view, 1> kInverse{"droop_Pa_per_m3ps"};

struct ScaledPlant {
  std::string_view plant;
  Names scale;  ///< held; all of them set the scale together
  Names also;   ///< besides masses and forces
};
constexpr std::array kScaled = {ScaledPlant{"force_driven_axis", kAxisScale, {}},
                                ScaledPlant{"hydraulic_actuator", kActuatorScale, kActuatorFlows},
                                ScaledPlant{"hydraulic_cylinder", kCylinderScale, kCylinderFlows}};

bool has(Names names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string last_word(const std::string& name) { return name.substr(name.rfind('.') + 1); }

}  // namespace

bool is_force(const std::string& name) {
  const std::string unit = config::units::unit_of(name);
  return unit == "kg" || unit == "N" || unit.starts_with("N ") || unit.starts_with("N/");
}

HeldScale held_scale(const plant_sim::ModelFile& model, const std::vector<std::string>& fitted) {
  const auto entry = std::find_if(kScaled.begin(), kScaled.end(),
                                  [&](const ScaledPlant& s) { return s.plant == model.plant; });
  if (entry == kScaled.end()) return {};
  HeldScale held;
  std::vector<std::string> holding;
  for (const std::string_view name : entry->scale) {
    if (std::find(fitted.begin(), fitted.end(), name) == fitted.end()) holding.emplace_back(name);
  }
  for (const std::string& name : fitted) {
    const std::string word = last_word(name);
    if (has(entry->also, word) || has(entry->scale, name) || is_force(name)) {
      held.scaled.push_back(name);
    }
    if (!entry->also.empty() && has(kInverse, word)) held.inverse.push_back(name);
  }
  if (holding.empty() || held.scaled.empty()) return {};
  held.parameter = holding.front();
  held.also_held.assign(holding.begin() + 1, holding.end());
  return held;
}

std::string held_scale_words(const plant_sim::ModelFile& model,
                             const std::vector<std::string>& fitted) {
  const HeldScale held = held_scale(model, fitted);
  if (held.parameter.empty()) return "";
  plant_sim::ModelFile copy = model;
  const auto value_words = [&](const std::string& name) {
    return config::units::words(config::units::quantity(name, *copy.value(name), std::nan("")));
  };
  const auto are = [](const std::vector<std::string>& names) {
    return (names.size() == 1 ? "is " : "are ") + config::schema::listed(names);
  };
  const bool one = held.also_held.empty();
  std::string text = held.parameter;
  for (const std::string& name : held.also_held) text += " and " + name;
  text += (one ? " is held at " : " are held at ") + value_words(held.parameter);
  for (const std::string& name : held.also_held) text += " and " + value_words(name);
  text += one ? ": command and position show only ratios to it. If it is 10 % larger, so "
              : ": command and position show only ratios to them. If they are 10 % larger, so ";
  text += are(held.scaled);
  if (!held.inverse.empty()) text += ", and 10 % smaller " + are(held.inverse);
  return text + "; their errors do not contain that.";
}

}  // namespace estimator::greybox
