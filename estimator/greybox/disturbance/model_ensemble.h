// A model at given parameters in all lanes of an ensemble, for runs that differ between the lanes
// in something else.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "estimator/greybox/free_parameter.h"
#include "plant_sim/ensemble.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox::disturbance {

/// The ensemble's step is that of a simulation of a record with `sample_time_s`. The numbers of a
/// change are ignored: its parameter keeps the value that it has at the start.
[[nodiscard]] std::unique_ptr<plant_sim::Ensemble> model_ensemble(
    const plant_sim::ModelFile& model, double sample_time_s,
    const std::vector<FreeParameter>& parameters, const Eigen::VectorXd& theta);

}  // namespace estimator::greybox::disturbance
