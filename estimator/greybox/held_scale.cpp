#include "estimator/greybox/held_scale.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "config/schema/joined.h"
#include "config/units/quantity.h"

namespace estimator::greybox {
namespace {

struct ScaledPlant {
  std::string_view plant;
  std::string_view scale;
  std::array<std::string_view, 3> also;  ///< besides masses and forces
};
constexpr std::array kScaled = {
    ScaledPlant{"force_driven_axis", "gain_N_per_V", {}},
    ScaledPlant{"hydraulic_actuator",
                "area_m2",
                {"valve_gain_m_per_V", "dead_volume_m3", "conductance_m3ps_per_Pa"}}};

/// True for a mass, a force, or a force per speed or way: "kg", "N", "N s/m".
bool is_force(const std::string& name) {
  const std::string unit = config::units::unit_of(name);
  return unit == "kg" || unit == "N" || unit.starts_with("N ") || unit.starts_with("N/");
}

std::string last_word(const std::string& name) { return name.substr(name.rfind('.') + 1); }

}  // namespace

HeldScale held_scale(const plant_sim::ModelFile& model, const std::vector<std::string>& fitted) {
  const auto entry = std::find_if(kScaled.begin(), kScaled.end(),
                                  [&](const ScaledPlant& s) { return s.plant == model.plant; });
  HeldScale held;
  if (entry == kScaled.end()) return held;
  for (const std::string& name : fitted) {
    if (name == entry->scale) return {};
    const bool also =
        std::find(entry->also.begin(), entry->also.end(), last_word(name)) != entry->also.end();
    if (also || is_force(name)) held.scaled.push_back(name);
  }
  if (held.scaled.empty()) return {};
  held.parameter = entry->scale;
  return held;
}

std::string held_scale_words(const plant_sim::ModelFile& model,
                             const std::vector<std::string>& fitted) {
  const HeldScale held = held_scale(model, fitted);
  if (held.parameter.empty()) return "";
  plant_sim::ModelFile copy = model;
  const double value = *copy.value(held.parameter);
  return held.parameter + " is held at " +
         config::units::words(config::units::quantity(held.parameter, value, std::nan(""))) +
         ": command and position show only ratios to it. If it is 10 % larger, so " +
         (held.scaled.size() == 1 ? "is " : "are ") + config::schema::listed(held.scaled) +
         "; their errors do not contain that.";
}

}  // namespace estimator::greybox
