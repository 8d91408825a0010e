// The stage of speeds: which pulse comes next, and what they say in the end.
#include <algorithm>
#include <cmath>

#include "daemon/control/commissioning.h"
#include "daemon/control/commissioning_shares.h"

namespace monitor::control {

using namespace shares;  // NOLINT(google-build-using-namespace)

void Commissioning::speed_pulse_over(double now_s, bool too_far) noexcept {
  Side& s = side(direction_);
  const double speed_mps =
      too_far ? std::numeric_limits<double>::infinity() : direction_ * after_.slope_mps();
  LevelSearch& search = s.found == 0 ? s.fast : s.slow;
  const bool in_reach = speed_mps >= kMoves * target_mps_;
  if (in_reach && !too_far) {
    const double v = direction_ * speed_mps;
    ++s.points;
    s.u += applied_V_;
    s.v += v;
    s.uu += applied_V_ * applied_V_;
    s.uv += applied_V_ * v;
    // The lines meet as sharply as the slopes differ.
    const double weight = v * v;
    latency_sum_ += weight * (after_.meets(before_) - move_s_);
    latency_weight_ += weight;
  }
  if (!too_far) improve_rest();
  search.take(speed_mps);
  if (search.state() == LevelSearch::State::at_limit && !in_reach) {
    fail(Failure::no_motion);
    return;
  }
  if (search.state() == LevelSearch::State::given_up) {
    fail(Failure::no_level);
    return;
  }
  const bool found = search.state() != LevelSearch::State::searching;
  if (found) ++s.found;
  if (found && sides_[0].found == 1 && sides_[1].found == 1) {
    for (const int direction : {-1, 1}) {
      Side& one = side(direction);
      one.slow =
          LevelSearch::between(kSlowLow * one.fast.speed_mps(), kSlowHigh * one.fast.speed_mps(),
                               direction * rest_V_, one.fast.level_V());
    }
  }
  if (sides_[0].found == 2 && sides_[1].found == 2) {
    evaluate();
  } else {
    start_pause(now_s);
  }
}

void Commissioning::improve_rest() noexcept {
  const double drift_mps = before_.slope_mps();
  const double change_mps = after_.slope_mps() - drift_mps;
  const double change_V = command_V_ - rest_V_;
  const double least_mps = kDrift * target_mps_;
  if (std::abs(drift_mps) < least_mps || change_mps * change_V <= 0.0 ||
      std::abs(change_mps) < least_mps) {
    return;
  }
  rest_V_ = std::clamp(rest_V_ - drift_mps * change_V / change_mps, -limits_.authority_V,
                       limits_.authority_V);
}

void Commissioning::next_speed(double now_s) noexcept {
  const double off_m = last_m_ - start_m_;
  const int back = off_m > 0.0 ? -1 : 1;
  int direction = back;
  if (!wants(side(back))) {
    if (std::abs(off_m) > kNear * limits_.max_travel_m) {
      start_drive(Drive::back, now_s, back, side(back).fast.level_V());
      return;
    }
    direction = -back;
  }
  const Side& s = side(direction);
  start_pulse(now_s, direction, (s.found == 0 ? s.fast : s.slow).level_V());
}

void Commissioning::evaluate() noexcept {
  double ends_V[2] = {};
  double gains[2] = {};
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const Side& s = sides_[i];
    const double n = s.points;
    gains[i] = (n * s.uv - s.u * s.v) / (n * s.uu - s.u * s.u);
    ends_V[i] = (s.u - s.v / gains[i]) / n;
  }
  if (!(gains[0] > 0.0 && gains[1] > 0.0)) {
    fail(Failure::no_level);
    return;
  }
  findings_.gain_mps_per_V = 0.5 * (gains[0] + gains[1]);
  findings_.null_V = 0.5 * (ends_V[0] + ends_V[1]);
  findings_.dead_zone_V = std::max(0.0, ends_V[1] - ends_V[0]);
  findings_.latency_s = std::max(0.0, latency_sum_ / latency_weight_);
  finish();
  if (findings_.latency_s > kLatest * kSettle * limits_.pulse_s) fail(Failure::too_slow);
}

}  // namespace monitor::control
