#include "daemon/control/commissioning.h"

#include <algorithm>
#include <cmath>

#include "config/signals/nan.h"

namespace monitor::control {
namespace {

using config::signals::kNaN;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Shares of max_travel.
constexpr double kTravelOfPulse = 0.35;  ///< at the target speed
constexpr double kEndOfPulse = 0.45;
constexpr double kEndOfStage = 0.8;
constexpr double kNear = 0.15;    ///< distance from the start within which a pulse may lead away
constexpr double kSeen = 0.04;    ///< detectable motion
constexpr double kNoisy = 0.2;    ///< limit of the noise
constexpr double kAgainst = 0.2;  ///< motion against the command
constexpr double kBackOff = 0.4;  ///< from a stop
// Shares of the target speed.
constexpr double kFastLow = 0.5;
constexpr double kMoves = 0.1;
constexpr double kDrift = 0.05;  ///< between pulses, to be corrected
// Shares of the speed of the faster pulse.
constexpr double kSlowLow = 0.2;
constexpr double kSlowHigh = 0.65;

constexpr double kFirstLevel = 1.0 / 32.0;  ///< share of the authority
constexpr double kSettle = 0.4;             ///< share of a pulse
/// Share of the settling time: a longer latency has not settled when the line fit begins.
constexpr double kLatest = 0.6;
constexpr double kRest_s = 0.4;
constexpr double kNoises = 10.0;  ///< detectable motion in standard deviations
/// Allowed difference of the command reported by a device, as a share of the authority: coarser
/// than any converter, finer than any scaling mistake.
constexpr double kSameCommand = 0.05;
constexpr double kStart_s = 0.3;  ///< until a drive must be moving
constexpr double kStill_s = 0.1;

}  // namespace

const char* to_string(Failure failure) noexcept {
  constexpr const char* kTexts[] = {"done",
                                    "the rod moved too far",
                                    "the rod moved too fast",
                                    "the rod moved against the command",
                                    "no motion at full authority",
                                    "the position is missing or stale",
                                    "the reading falls as the command rises",
                                    "the reading is too noisy for such a small travel",
                                    "no command gives a steady speed within the travel",
                                    "the rod responds too late for such short pulses",
                                    "reached a stop before the index",
                                    "the stage takes too long"};
  return kTexts[static_cast<std::size_t>(failure)];
}

Commissioning::Commissioning(const CommissioningLimits& limits) noexcept
    : limits_(limits), target_mps_(kTravelOfPulse * limits.max_travel_m / limits.pulse_s) {}

void Commissioning::begin(Stage stage) noexcept {
  stage_ = stage;
  over_ = begun_ = false;
  failure_ = Failure::none;
  window_ = 0;
  travel_m_ = speed_mps_ = 0.0;
  rest_V_ = 0.0;
  sign_level_V_ = 0.0;
  last_t_s_ = -kInfinite;
  stage_s_ = fresh_s_ = kNaN;
  if (stage == Stage::speeds) {
    for (Side& side : sides_) {
      side = Side();
      side.fast = LevelSearch(kFastLow * target_mps_, target_mps_,
                              kFirstLevel * limits_.authority_V, limits_.authority_V);
    }
    latency_sum_ = latency_weight_ = 0.0;
  }
}

void Commissioning::begin_home(int direction, bool index) noexcept {
  begin(Stage::home);
  home_direction_ = direction;
  index_ = index;
}

void Commissioning::fail(Failure failure) noexcept {
  failure_ = failure;
  finish();
}

void Commissioning::finish() noexcept {
  over_ = true;
  command_V_ = 0.0;
}

bool Commissioning::watch(const Input& in) noexcept {
  if (in.now_s - stage_s_ > limits_.most_s) fail(Failure::too_long);
  if (in.usable) {
    fresh_s_ = in.now_s;
  } else if (in.now_s - fresh_s_ > limits_.max_gap_s) {
    fail(Failure::no_reading);
  }
  if (!in.usable || in.t_s <= last_t_s_) return false;
  last_t_s_ = in.t_s;
  last_m_ = in.y_m;
  if (!begun_) {
    begun_ = true;
    start_m_ = in.y_m;
    if (stage_ == Stage::home) {
      const double level_V = 0.5 * findings_.dead_zone_V + target_mps_ / findings_.gain_mps_per_V;
      start_drive(Drive::home, in.now_s, home_direction_,
                  home_direction_ * findings_.null_V + level_V);
    } else {
      start_pause(in.now_s);
    }
  }
  travel_m_ = std::max(travel_m_, std::abs(in.y_m - start_m_));
  const bool home = stage_ == Stage::home;
  if (travel_m_ > (home ? limits_.home_travel_m : kEndOfStage * limits_.max_travel_m)) {
    fail(Failure::travel);
  }
  const auto slot = static_cast<std::size_t>(window_ % kWindow);
  if (window_ >= kWindow) {
    speed_mps_ = (in.y_m - window_m_[slot]) / (in.t_s - window_t_s_[slot]);
    if (std::abs(speed_mps_) > limits_.max_speed_mps) fail(Failure::speed);
  }
  window_t_s_[slot] = in.t_s;
  window_m_[slot] = in.y_m;
  ++window_;
  return true;
}

double Commissioning::step(const Input& in) noexcept {
  if (over_) return 0.0;
  if (std::isnan(stage_s_)) stage_s_ = fresh_s_ = in.now_s;
  if (stage_ == Stage::home && index_ && in.usable && in.homed) {
    findings_.home_m = in.y_m;
    finish();
    return 0.0;
  }
  const bool fresh = watch(in);
  if (over_ || !begun_) return 0.0;
  applied_V_ = std::abs(in.applied_V - command_V_) < kSameCommand * limits_.authority_V
                   ? in.applied_V
                   : command_V_;
  if (in.disturbed && move_ != Move::drive) {
    start_pause(in.now_s);
    return command_V_;
  }
  const double gone_s = in.now_s - move_s_;
  const double settle_s = kSettle * limits_.pulse_s;
  switch (move_) {
    case Move::pause:
      if (fresh && in.t_s >= move_s_ + settle_s) before_.add(in.t_s, in.y_m);
      if (gone_s >= (stage_ == Stage::rest ? kRest_s : limits_.pulse_s) && before_.count() > 2) {
        pause_over(in.now_s);
      }
      break;
    case Move::pulse:
      if (fresh && in.t_s >= move_s_ + settle_s) after_.add(in.t_s, in.y_m);
      pulse(in, fresh);
      break;
    case Move::drive:
      if (fresh) drive(in);
      break;
  }
  return command_V_;
}

void Commissioning::start_pause(double now_s) noexcept {
  move_ = Move::pause;
  move_s_ = now_s;
  command_V_ = rest_V_;
  before_.clear();
}

void Commissioning::start_pulse(double now_s, int direction, double level_V) noexcept {
  move_ = Move::pulse;
  move_s_ = now_s;
  move_m_ = last_m_;
  direction_ = direction;
  command_V_ = std::clamp(direction * level_V, -limits_.authority_V, limits_.authority_V);
  after_.clear();
}

void Commissioning::start_drive(Drive what, double now_s, int direction, double level_V) noexcept {
  start_pulse(now_s, direction, level_V);
  move_ = Move::drive;
  drive_ = what;
  still_s_ = kNaN;
}

void Commissioning::pause_over(double now_s) noexcept {
  switch (stage_) {
    case Stage::rest:
      findings_.noise_m = before_.noise_m();
      findings_.drift_mps = before_.slope_mps();
      finish();
      if (kNoises * findings_.noise_m > kNoisy * limits_.max_travel_m) fail(Failure::too_noisy);
      break;
    case Stage::sign:
      // A pulse and its opposite, so that travel unseen by a dead sensor is undone. The first one
      // is against the drift.
      if (sign_level_V_ > 0.0 && direction_ == sign_first_) {
        start_pulse(now_s, -sign_first_, sign_level_V_);
        break;
      }
      if (sign_level_V_ == 0.0) sign_first_ = findings_.drift_mps > kDrift * target_mps_ ? -1 : 1;
      sign_level_V_ = sign_level_V_ > 0.0 ? 2.0 * sign_level_V_ : kFirstLevel * limits_.authority_V;
      start_pulse(now_s, sign_first_, sign_level_V_);
      break;
    case Stage::speeds:
      next_speed(now_s);
      break;
    case Stage::home:
      finish();
      break;
  }
}

void Commissioning::pulse(const Input& in, bool fresh) noexcept {
  const bool over = in.now_s - move_s_ >= limits_.pulse_s && after_.count() > 2;
  if (stage_ == Stage::sign) {
    const double seen_m = in.y_m - before_.at(in.t_s);
    if (fresh &&
        std::abs(seen_m) > std::max(kSeen * limits_.max_travel_m, kNoises * findings_.noise_m)) {
      findings_.sign_V = command_V_;
      findings_.sign_m = seen_m;
      finish();
      if (findings_.sign_m * findings_.sign_V < 0.0) fail(Failure::reversed);
    } else if (over) {
      sign_pulse_over(in.now_s);
    }
    return;
  }
  const bool beyond_rest = direction_ * (command_V_ - rest_V_) > 0.0;
  const double against_m = -direction_ * (last_m_ - before_.at(last_t_s_));
  if (beyond_rest && against_m > kAgainst * limits_.max_travel_m) {
    fail(Failure::wrong_way);
    return;
  }
  const bool too_far = std::abs(last_m_ - move_m_) > kEndOfPulse * limits_.max_travel_m;
  if (over || too_far) speed_pulse_over(in.now_s, too_far);
}

void Commissioning::sign_pulse_over(double now_s) noexcept {
  if (direction_ != sign_first_ && sign_level_V_ >= limits_.authority_V) {
    fail(Failure::no_motion);
  } else {
    start_pause(now_s);
  }
}

void Commissioning::drive(const Input& in) noexcept {
  const double gone_m = direction_ * (in.y_m - move_m_);
  if (gone_m < -kAgainst * limits_.max_travel_m) {
    fail(Failure::wrong_way);
    return;
  }
  const bool under_way = in.now_s - move_s_ >= kStart_s;
  const bool still = under_way && std::abs(speed_mps_) < kMoves * target_mps_;
  if (!still) still_s_ = kNaN;
  if (still && std::isnan(still_s_)) still_s_ = in.now_s;
  const bool stands = still && in.now_s - still_s_ >= kStill_s;
  switch (drive_) {
    case Drive::back:
      if (direction_ * (in.y_m - start_m_) >= 0.0) {
        start_pause(in.now_s);
      } else if (stands) {
        fail(Failure::no_motion);
      }
      break;
    case Drive::home:
      if (!stands) break;
      if (index_) {
        fail(Failure::no_index);
        break;
      }
      findings_.home_m = in.y_m;
      start_drive(Drive::back_off, in.now_s, -direction_,
                  -direction_ * findings_.null_V + 0.5 * findings_.dead_zone_V +
                      target_mps_ / findings_.gain_mps_per_V);
      break;
    case Drive::back_off:
      if (gone_m > kBackOff * limits_.max_travel_m) {
        finish();
      } else if (stands) {
        fail(Failure::no_motion);
      }
      break;
  }
}

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
    // The intersection is as sharp as the slopes differ.
    const double weight = v * v;
    latency_sum_ += weight * (after_.meets(before_) - move_s_);
    latency_weight_ += weight;
  }
  if (!too_far) improve_rest();
  search.update(speed_mps);
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
