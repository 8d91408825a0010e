// A load that sets in: a jump of the disturbance force at one sample, which a random force of that
// size does not make.
//
//   z(k+1) = A (I - K c') z(k),   e(k) = c' z(k)
//
// A jump of F at sample k moves the innovations from there on. With unit variance of these, score
// and information of it follow from one pass backwards over the record,
//
//   s(k) = (I - K c')' A' s(k+1) + c e(k),   J(k) = (I - K c')' A' J(k+1) A (I - K c') + c c',
//
// and its likelihood gains s_F^2 / (2 J_FF). Source: A. Willsky, H. Jones, IEEE Transactions on
// Automatic Control 21 (1976) 108.
#pragma once

#include <Eigen/Core>

#include "estimator/greybox/disturbance/linearisation.h"
#include "estimator/greybox/innovation_gains.h"

namespace estimator::greybox::disturbance {

struct ForceJump {
  double gain_nats = 0.0;
  /// Gain of the third likeliest jump a second or more from others: of a disturbance that jumps by
  /// itself, or of what else the model lacks.
  double usual_nats = 0.0;
  double time_s = 0.0;
  double size = 0.0;  ///< N; m/s for a plant without forces
};

/// The likeliest jump within the record. `innovations`: samples, scaled by `unit` to variance 1.
[[nodiscard]] ForceJump likeliest_jump(const Linearisation& model, const Dataset& record,
                                       const InnovationGains& gains,
                                       const Eigen::VectorXd& innovations, double unit);

}  // namespace estimator::greybox::disturbance
