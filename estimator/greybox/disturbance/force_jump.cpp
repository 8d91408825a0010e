#include "estimator/greybox/disturbance/force_jump.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "estimator/greybox/disturbance/predictor.h"

namespace estimator::greybox::disturbance {

using Eigen::Index;

namespace {

constexpr double kApart_s = 1.0;
constexpr std::size_t kUsual = 3;

/// The likeliest of all jumps beside the usual ones.
ForceJump standing_out(std::vector<ForceJump> jumps) {
  std::vector<ForceJump> separate;
  while (separate.size() < kUsual && !jumps.empty()) {
    const ForceJump best = *std::max_element(
        jumps.begin(), jumps.end(),
        [](const ForceJump& a, const ForceJump& b) { return a.gain_nats < b.gain_nats; });
    separate.push_back(best);
    std::erase_if(jumps, [&](const ForceJump& jump) {
      return std::abs(jump.time_s - best.time_s) < kApart_s;
    });
  }
  if (separate.empty()) return {};
  ForceJump best = separate.front();
  if (separate.size() == kUsual) best.usual_nats = separate.back().gain_nats;
  return best;
}

}  // namespace

ForceJump likeliest_jump(const Linearisation& model, const Dataset& record,
                         const InnovationGains& gains, const Eigen::VectorXd& innovations,
                         double unit) {
  std::vector<ForceJump> jumps;
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
    if (gain_nats > 0.0)
      jumps.push_back({gain_nats, 0.0, record.t_s[row], score[kDisturbance] / weight});
    // a segment begins with an unknown force
    if (std::binary_search(record.starts.begin(), record.starts.end(), row)) {
      score.setZero();
      information.setZero();
    }
  }
  return standing_out(std::move(jumps));
}

}  // namespace estimator::greybox::disturbance
