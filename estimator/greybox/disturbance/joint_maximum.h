// A model's parameters and its noise model where both together are likeliest.
//
//   -2 log posterior = sum e^2 / S + sum log S + sum ((theta - mean) / sd)^2
//
// over theta and the noise parameters at once, the predictor's gains following them. A fit with
// frozen gains, in turn with the noise model, ends short of that where a resonance decides the
// gains, or where a parameter and a disturbance stand in for each other.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "estimator/greybox/disturbance/noise_model.h"

namespace estimator::greybox::disturbance {

struct JointMaximum {
  Eigen::VectorXd theta;
  NoiseModel noise;
};

/// The maximum that is nearest to `theta` and `noise`, from which the innovations of `data` must
/// come. The lines stay, and what they move is projected out as it was at the start: the likelihood
/// at the maximum is the caller's to take.
[[nodiscard]] JointMaximum joint_maximum(const plant_sim::ModelFile& model, const FitDataset& data,
                                         const std::vector<FreeParameter>& parameters,
                                         const Eigen::VectorXd& theta, const NoiseModel& noise,
                                         unsigned threads, const std::function<bool()>& cancel);

}  // namespace estimator::greybox::disturbance
