#include "workbench/diagnose/residual_source.h"

#include <algorithm>

#include "config/units/quantity.h"
#include "estimator/greybox/kinematics.h"
#include "estimator/greybox/observer_simulation.h"

namespace workbench::diagnose {

namespace greybox = estimator::greybox;

ResidualSource residual_source(const plant_sim::ModelFile& model, const greybox::Dataset& record,
                               const std::vector<double>& residual_m) {
  constexpr double kMillimetres = 1e3;
  constexpr double kObserver_per_s = greybox::kObserver_per_s;
  greybox::Dataset error = record;
  error.y_m = residual_m;
  const greybox::Kinematics moved = greybox::kinematics(error, 0.0);
  plant_sim::ModelFile copy = model;
  const bool forces = model.plant == "force_driven_axis";
  const double mass_kg = forces ? *copy.value("mass_kg") : 0.0;
  const double damping_N_s_per_m = forces ? *copy.value("damping_N_s_per_m") : 0.0;
  ResidualSource source;
  source.axis = forces ? present::Axis{config::units::axis_words("residual force"), "N"}
                       : present::Axis{"speed error", "mm/s"};
  for (std::size_t k = 0; k < residual_m.size(); ++k) {
    const double w_mps = moved.speed_mps[k] + kObserver_per_s * residual_m[k];
    const double slope_mps2 = moved.acceleration_mps2[k] + kObserver_per_s * moved.speed_mps[k];
    source.values.push_back(forces ? -(mass_kg * slope_mps2 + damping_N_s_per_m * w_mps)
                                   : kMillimetres * w_mps);
  }
  return source;
}

}  // namespace workbench::diagnose
