// Where a residual arises, sample by sample. A position error lasts long after its cause: what
// shows the cause is the force that the model lacks, or the speed by which it is off.
//
//   speed error     w = e' + l e                       e residual, l observer gain
//   residual force  -(M w' + d w)                      of a force-driven axis, against extension
//
// e' and e'' are those of a parabola through 50 ms to either side (greybox/kinematics.h).
#pragma once

#include <vector>

#include "estimator/greybox/dataset.h"
#include "plant_sim/model_file.h"
#include "workbench/present/report.h"

namespace workbench::diagnose {

struct ResidualSource {
  present::Axis axis;          ///< "residual force", N; or "speed error", mm/s
  std::vector<double> values;  ///< in the axis' unit; NaN where the residual is
};

/// `residual_m` of each sample of the record under the observer, NaN where it does not count;
/// `model` is the one that left it.
[[nodiscard]] ResidualSource residual_source(const plant_sim::ModelFile& model,
                                             const estimator::greybox::Dataset& record,
                                             const std::vector<double>& residual_m);

}  // namespace workbench::diagnose
