// Simulated effect of a random disturbance: dry friction lets less of it through than the model
// linearised about its trajectory does.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/greybox/dataset.h"
#include "estimator/greybox/disturbance/kalman_gains.h"
#include "estimator/greybox/free_parameter.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox::disturbance {

/// RMS (m) of readings with random forces, or speeds where the plant has no force, of the noise's
/// size and corner less the reading without; all are corrected by a weak observer. Seven fixed
/// courses are taken, so that the answer is the same each time. `force_place`: as
/// plant_sim::Ensemble::place_disturbance().
[[nodiscard]] double simulated_disturbance_rms_m(const plant_sim::ModelFile& model,
                                                 const Dataset& record,
                                                 const std::vector<FreeParameter>& parameters,
                                                 const Eigen::VectorXd& theta,
                                                 const NoiseParameters& noise,
                                                 double force_place = plant_sim::kPlaceOfSensor);

}  // namespace estimator::greybox::disturbance
