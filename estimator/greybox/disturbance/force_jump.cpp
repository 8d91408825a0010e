#include "estimator/greybox/disturbance/force_jump.h"

#include <algorithm>

#include "estimator/greybox/disturbance/predictor.h"

namespace estimator::greybox::disturbance {

using Eigen::Index;

ForceJump likeliest_jump(const Linearisation& model, const Dataset& record,
                         const InnovationGains& gains, const Eigen::VectorXd& innovations,
                         double unit) {
  ForceJump best;
  StateVector score = StateVector::Zero();
  StateMatrix information = StateMatrix::Zero();
  for (Index k = innovations.size() - 1; k >= 0; --k) {
    const auto row = static_cast<std::size_t>(k);
    StateMatrix step = StateMatrix::Identity();
    step.col(0) -= gain_at(gains, k);
    step = (transition_at(model, gains, row) * step).eval();
    score = (step.transpose() * score).eval();
    information = (step.transpose() * information * step).eval();
    if (record.valid[row] != 0) {
      const double scale = gains.scale[k] / unit;
      score[0] += scale * innovations[k] / unit;
      information(0, 0) += scale * scale;
    }
    const double weight = information(kDisturbance, kDisturbance);
    const double gain_nats =
        weight > 0.0 ? 0.5 * score[kDisturbance] * score[kDisturbance] / weight : 0.0;
    if (gain_nats > best.gain_nats) {
      best = {gain_nats, record.t_s[row], score[kDisturbance] / weight};
    }
    // a segment begins with an unknown force
    if (std::binary_search(record.starts.begin(), record.starts.end(), row)) {
      score.setZero();
      information.setZero();
    }
  }
  return best;
}

}  // namespace estimator::greybox::disturbance
