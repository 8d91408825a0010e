// Magnitudes of a rig and its motion: lengths, speeds, commands, forces.
#pragma once

#include "estimator/greybox/fit_dataset.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox::selection {

/// By default the rig to which the library's typical sizes belong.
struct RigScale {
  double length_m = 0.02;  ///< RMS of the position about its mean
  double centre_m = 0.3;   ///< middle of the motion
  double speed_mps = 0.06;
  double command_V = 0.7;
  double command_sd_V = 0.7;  ///< about its mean
  double most_command_V = 4.0;
  double force_N = 4400.0;  ///< greatest
  double pressure_Pa = 6.9e6;
  double area_m2 = 6.3e-4;
};

/// Motion and command from the records; force, flow and pressure from the model.
[[nodiscard]] RigScale rig_scale(plant_sim::ModelFile model, const FitDataset& data);

}  // namespace estimator::greybox::selection
