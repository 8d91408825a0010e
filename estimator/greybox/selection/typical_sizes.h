// Typical sizes of effects on the rig at hand: those of the library belong to an actuator of 5 kN
// that moves by centimetres; an effect of a rig of another kind is looked for about other sizes.
#pragma once

#include <vector>

#include "estimator/greybox/fit_dataset.h"
#include "plant_sim/library.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox::selection {

/// Scales `typical` of every parameter by its unit, in whole decades, with the motion and command
/// of the records and the model's greatest force, flow and pressure. Formulas, whose file states
/// their typical sizes, and what acts on the valve's spool stay as they are.
void scale_typical_sizes(const plant_sim::ModelFile& model, const FitDataset& data,
                         std::vector<plant_sim::EffectInfo>& effects);

}  // namespace estimator::greybox::selection
