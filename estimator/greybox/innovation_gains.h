// Kalman gains that turn a simulation into a one-step predictor whose residual is white where the
// process is disturbed as its noise model says (disturbance/kalman_gains.h computes them).
//
//   e(k) = y(k) - yl(k) - yh(k),   r(k) = scale(k) e(k)
//   x(k) += K(k) e(k),             F(k+1) = decay (F(k) + K_F e)
//
// yl  what spectral lines known so far move the reading by: the gains were computed without them
// x  states of the plant (of a second mass too: correcting its offset z leaves the reading), F
// process disturbance (a force, or a speed where the plant has no force). A fit of
// candidates freezes the gains of the model that they extend; in joint_maximum() and for standard
// errors they follow the parameters.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "plant_sim/coupled_step.h"

namespace estimator::greybox {

struct InnovationGains {
  std::vector<std::string> states;  ///< corrected, in the order of the rows of `gain`
  Eigen::MatrixXd gain;             ///< (states + 1) x samples; the last row is that of F
  double decay = 0.0;               ///< decay of F from sample to sample
  Eigen::VectorXd scale;            ///< sensor noise over the standard deviation of e
  /// samples x 2 columns per spectral line: orthonormal signatures that are projected out of r.
  Eigen::MatrixXd lines;
  Eigen::VectorXd line_m;  ///< yl, samples; empty: none
  /// Place of a force F, as plant_sim::Ensemble::place_disturbance().
  double force_place = plant_sim::kPlaceOfSensor;

  /// Samples [from, to).
  [[nodiscard]] InnovationGains part(Eigen::Index from, Eigen::Index to) const;
};

}  // namespace estimator::greybox
