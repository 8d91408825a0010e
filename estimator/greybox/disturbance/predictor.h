// The one-step predictor of a linearised model at one sample.
#pragma once

#include "estimator/greybox/disturbance/linearisation.h"
#include "estimator/greybox/innovation_gains.h"

namespace estimator::greybox::disturbance {

inline constexpr Eigen::Index kDisturbance = kMostStates - 1;  ///< the state F

/// A with the decay of F.
[[nodiscard]] inline StateMatrix transition_at(const Linearisation& model,
                                               const InnovationGains& gains, std::size_t k) {
  StateMatrix a = model.transition[k];
  a(kDisturbance, kDisturbance) = gains.decay;
  return a;
}

/// K.
[[nodiscard]] inline StateVector gain_at(const InnovationGains& gains, Eigen::Index k) {
  StateVector gain = StateVector::Zero();
  const Eigen::Index count = gains.gain.rows() - 1;
  gain.head(count) = gains.gain.col(k).head(count);
  gain[kDisturbance] = gains.gain(count, k);
  return gain;
}

}  // namespace estimator::greybox::disturbance
