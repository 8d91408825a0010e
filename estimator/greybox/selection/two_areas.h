// A double-rod actuator taken for a cylinder whose rod side may have another area.
#pragma once

#include "plant_sim/model_file.h"

namespace estimator::greybox::selection {

/// The numbers of a hydraulic_actuator's model, without its effects, as a hydraulic_cylinder with
/// two equal areas, which moves alike; a fit may change the rod side's.
[[nodiscard]] plant_sim::ModelFile with_two_areas(const plant_sim::ModelFile& actuator);

}  // namespace estimator::greybox::selection
