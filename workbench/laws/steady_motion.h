// The motion that a model settles to under constant commands, away from the ends of its stroke: the
// characteristic of its valve, and the force that it takes to move so fast.
//
//   hydraulic_actuator   F = A (Pi - Po)        hydraulic_cylinder   F = Ac Pi - Ar Po
//   force_driven_axis    F = gain * u           velocity_servo       no force
#pragma once

#include <vector>

#include "plant_sim/model_file.h"

namespace workbench::laws {

struct SteadyMotion {
  std::vector<double> command_V;
  std::vector<double> speed_mps;  ///< NaN: it does not settle within 10 s
  /// Force that drives, which in steady motion is the one that resists; NaN also where the plant
  /// has none.
  std::vector<double> force_N;
};

/// At the given commands, with the model before any change. Throws config::schema::ConfigError like
/// plant_sim::make_ensemble().
[[nodiscard]] SteadyMotion steady_motion(const plant_sim::ModelFile& model,
                                         const std::vector<double>& commands_V);

}  // namespace workbench::laws
