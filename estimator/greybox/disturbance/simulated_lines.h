// Simulated effect of known spectral lines: flow that saturates, friction and play let less of a
// line through than the model linearised about its trajectory does.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/greybox/dataset.h"
#include "estimator/greybox/disturbance/spectral_lines.h"
#include "estimator/greybox/free_parameter.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox::disturbance {

/// Reading (samples, m) with the lines less that without them, of two simulations with `theta` that
/// a weak observer corrects alike. `waves`: amplitudes of sine and cosine in the units of the
/// sites. `force_place`: as plant_sim::Ensemble::place_disturbance().
[[nodiscard]] Eigen::VectorXd simulated_lines_m(const plant_sim::ModelFile& model,
                                                const Dataset& record,
                                                const std::vector<FreeParameter>& parameters,
                                                const Eigen::VectorXd& theta,
                                                const std::vector<SpectralLine>& lines,
                                                const std::vector<Eigen::Vector2d>& waves,
                                                double force_place = plant_sim::kPlaceOfSensor);

/// Error (samples, m) that the lines leave in a simulation without them, each of the two corrected
/// by a weak observer of its own; arguments as above.
[[nodiscard]] Eigen::VectorXd simulated_line_error_m(
    const plant_sim::ModelFile& model, const Dataset& record,
    const std::vector<FreeParameter>& parameters, const Eigen::VectorXd& theta,
    const std::vector<SpectralLine>& lines, const std::vector<Eigen::Vector2d>& waves,
    double force_place = plant_sim::kPlaceOfSensor);

}  // namespace estimator::greybox::disturbance
