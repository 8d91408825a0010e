#include "estimator/greybox/selection/two_areas.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "plant_sim/hydraulics.h"
#include "plant_sim/library.h"

namespace estimator::greybox::selection {
namespace {

/// Relative width of the rod side's prior: rods take up to half of a piston.
constexpr double kRodSide_ratio = 0.5;
/// Damping ratio of the spool below which a bandwidth is not defined in the library.
constexpr double kLeastDamping = 0.1;

void copy(const plant_sim::ModelFile& from, const std::string& name, plant_sim::ModelFile& to,
          const std::string& as) {
  plant_sim::ModelFile source = from;
  const double* value = source.value(name);
  double* place = to.value(as);
  if (value == nullptr || place == nullptr) return;
  *place = *value;
  for (std::size_t i = 0; i < from.parameters.size(); ++i) {
    if (from.parameters[i].name != name) continue;
    const auto prior = std::find_if(to.priors.begin(), to.priors.end(),
                                    [&](const auto& one) { return one.name == as; });
    if (prior != to.priors.end()) prior->value = from.uncertainty_ratio(i);
  }
}

/// Flow per area of an orifice and root of the drop.
double flow_per_m2(plant_sim::ModelFile actuator) {
  return *actuator.value("discharge_coefficient") *
         std::sqrt(2.0 / *actuator.value("density_kg_per_m3"));
}

}  // namespace

plant_sim::ModelFile with_two_areas(const plant_sim::ModelFile& actuator) {
  const plant_sim::PlantInfo& plant = *plant_sim::find_plant("hydraulic_cylinder");
  plant_sim::ModelFile model;
  model.name = actuator.name;
  model.plant = plant.name;
  model.step_s = actuator.step_s;
  model.parameters.clear();
  model.priors.clear();
  for (const plant_sim::ParameterInfo& p : plant.parameters) {
    model.parameters.push_back({p.name, p.neutral});
    model.priors.push_back({p.name, std::nan("")});
  }
  model.initial = actuator.initial;
  for (const auto& [from, as] :
       {std::pair{"mass_kg", "mass_kg"}, std::pair{"area_m2", "cap_area_m2"},
        std::pair{"area_m2", "rod_side_area_m2"},
        std::pair{"damping_N_s_per_m", "damping_N_s_per_m"},
        std::pair{"bulk_modulus_Pa", "bulk_modulus_Pa"},
        std::pair{"dead_volume_m3", "cap_dead_volume_m3"},
        std::pair{"dead_volume_m3", "rod_dead_volume_m3"}, std::pair{"stroke_m", "stroke_m"},
        std::pair{"supply_pressure_Pa", "supply_pressure_Pa"},
        std::pair{"return_pressure_Pa", "return_pressure_Pa"},
        std::pair{"valve_gain_m_per_V", "rated_flow_m3ps"},
        std::pair{"valve_natural_frequency_rad_per_s", "valve_bandwidth_Hz"},
        std::pair{"valve_damping_ratio", "valve_damping_ratio"},
        std::pair{"retracted_cushion_length_m", "retracted_cushion_length_m"},
        std::pair{"extended_cushion_length_m", "extended_cushion_length_m"}}) {
    copy(actuator, from, model, as);
  }
  for (auto& prior : model.priors) {
    if (prior.name == "rod_side_area_m2") prior.value = kRodSide_ratio;
  }
  const plant_sim::Hydraulics oil = plant_sim::hydraulics_of(actuator).value();
  double& travel_m = *model.value("rated_travel_m");
  travel_m = oil.valve_gain_m_per_V * *model.value("rated_command_V");
  *model.value("rated_flow_m3ps") =
      oil.orifice * travel_m * std::sqrt(*model.value("rated_drop_Pa"));
  for (const auto& [from, as] :
       {std::pair{"retracted_cushion_orifice_m2", "retracted_cushion_flow_m3ps"},
        std::pair{"extended_cushion_orifice_m2", "extended_cushion_flow_m3ps"}}) {
    copy(actuator, from, model, as);
    *model.value(as) *= flow_per_m2(actuator) * std::sqrt(*model.value("rated_drop_Pa"));
  }
  double& zeta = *model.value("valve_damping_ratio");
  zeta = std::max(zeta, kLeastDamping);
  const double k = 2.0 * zeta * zeta - 1.0;
  *model.value("valve_bandwidth_Hz") /=
      2.0 * std::numbers::pi * std::sqrt(k + std::sqrt(k * k + 1.0));
  return model;
}

}  // namespace estimator::greybox::selection
