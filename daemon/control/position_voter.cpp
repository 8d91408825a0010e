#include "daemon/control/position_voter.h"

#include <algorithm>
#include <cmath>

namespace monitor::control {

SensorWatch::SensorWatch(const std::vector<GuardConfig>& guards) {
  for (std::size_t i = 0; i < guards.size(); ++i) {
    if (watches_a_sensor(guards[i].which())) guards_.push_back({i, Guard(guards[i])});
  }
}

void SensorWatch::watch(const GuardInputs& inputs, double period_s) noexcept {
  for (Watched& each : guards_) {
    each.guard.watch(inputs, last_.dy_m(inputs), last_.dt_s(inputs), period_s);
  }
  last_.update(inputs);
}

void SensorWatch::start(double y_m) noexcept {
  for (Watched& each : guards_) each.guard.start(y_m);
}

void SensorWatch::take_limits(const std::vector<Guard>& guards) noexcept {
  for (Watched& each : guards_) {
    if (each.number < guards.size()) each.guard.take_limits(guards[each.number]);
  }
}

RodFault SensorWatch::fault() const noexcept {
  for (const Watched& each : guards_) {
    if (!each.guard.active()) continue;
    switch (each.guard.kind()) {
      case GuardKind::stale:
        return RodFault::stale;
      case GuardKind::frozen:
        return RodFault::frozen;
      default:
        return RodFault::jump;
    }
  }
  return RodFault::none;
}

bool SensorWatch::still(double t_s) const noexcept {
  for (const Watched& each : guards_) {
    if (each.guard.kind() != GuardKind::frozen) continue;
    if (2.0 * each.guard.lasting_s(t_s) >= each.guard.time_s()) return true;
  }
  return false;
}

namespace {

/// A bus device may need this long for its first reading.
constexpr double kFirstReading_s = 2.0;

}  // namespace

PositionVoter::PositionVoter(const FailoverConfig& config, const std::vector<GuardConfig>& guards,
                             const Settings& settings)
    : config_(config),
      settings_(settings),
      confirm_(std::max<std::int64_t>(1, std::llround(config.confirm_s / settings.sample_time_s))),
      return_ticks_(std::ceil(config.return_s / settings.sample_time_s)) {
  rods_.reserve(kMaxRods);
  for (std::size_t i = 0; i < kMaxRods; ++i) rods_.push_back({SensorWatch(guards)});
}

void PositionVoter::start() noexcept {
  for (Rod& rod : rods_) rod.watch.start(rod.y_m);
  readmit();
}

void PositionVoter::take_limits(const std::vector<Guard>& guards) noexcept {
  for (Rod& rod : rods_) rod.watch.take_limits(guards);
}

void PositionVoter::read(std::span<const RodReading> rods, double t_s, double command_V) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    Rod& rod = rods_[i];
    rod.before_m = rod.y_m;
    rod.y_m = rods[i].y_m;
    const bool there = std::isfinite(rod.y_m);
    rod.seen = rod.seen || there;
    rod.missing = there ? 0 : rod.missing + 1;
    GuardInputs inputs;
    inputs.t_s = t_s;
    inputs.y_m = rod.y_m;
    inputs.age_s = rods[i].age_s;
    inputs.called_stale = rods[i].called_stale;
    inputs.command_V = command_V;
    rod.watch.watch(inputs, settings_.sample_time_s);
  }
}

void PositionVoter::compare() noexcept {
  std::array<double, kMaxRods> in{};  // in rising order
  voters_ = 0;
  difference_m_ = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    const double y_m = rods_[i].y_m;
    if (!std::isfinite(y_m)) continue;
    if (!config_.present) {
      const double apart_m = std::abs(y_m - rods_[0].y_m);
      if (apart_m > difference_m_) difference_m_ = apart_m;
    } else if (rods_[i].fault == RodFault::none) {
      std::size_t at = voters_++;
      for (; at > 0 && in[at - 1] > y_m; --at) in[at] = in[at - 1];
      in[at] = y_m;
    }
  }
  if (!config_.present) return;
  middle_m_ = std::numeric_limits<double>::quiet_NaN();
  if (voters_ == 0) return;
  middle_m_ = 0.5 * (in[(voters_ - 1) / 2] + in[voters_ / 2]);
  if (voters_ == 2) difference_m_ = in[1] - in[0];
  if (voters_ < 3) return;
  // One end is the farthest; the second-farthest is an end of the remaining ones.
  const bool top = in[voters_ - 1] - middle_m_ > middle_m_ - in[0];
  const double low_m = middle_m_ - in[top ? 0 : 1];
  const double high_m = in[voters_ - (top ? 2 : 1)] - middle_m_;
  difference_m_ = std::max(low_m, high_m);
}

std::size_t PositionVoter::other(std::size_t rod, bool must_move, double t_s) const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    const Rod& each = rods_[i];
    const bool right = i != rod && each.fault == RodFault::none && std::isfinite(each.y_m) &&
                       each.watch.fault() == RodFault::none;
    if (right && !(must_move && each.watch.still(t_s))) return i;
  }
  return kMaxRods;
}

void PositionVoter::judge(std::size_t i, double t_s, bool controlling) noexcept {
  Rod& rod = rods_[i];
  if (rod.fault != RodFault::none) return;
  const bool there = std::isfinite(rod.y_m);
  const bool votes = there && voters_ >= 3;
  rod.against = votes && std::abs(rod.y_m - middle_m_) > config_.tolerance_m ? rod.against + 1 : 0;
  RodFault fault = there ? rod.watch.fault() : RodFault::none;
  if (fault == RodFault::none && rod.against >= confirm_) fault = RodFault::outvoted;
  const bool waits = !rod.seen && t_s < kFirstReading_s;
  if (!there &&
      ((controlling && i == in_charge_) || (rod.missing > settings_.max_missing && !waits))) {
    fault = RodFault::missing;
  }
  if (fault == RodFault::none || other(i, fault == RodFault::frozen, t_s) == kMaxRods) return;
  rod.fault = fault;
  rod.against = rod.right = 0;
}

void PositionVoter::readmit_if_right(std::size_t i) noexcept {
  Rod& rod = rods_[i];
  if (rod.fault == RodFault::none) return;
  const bool agrees = std::isnan(middle_m_) || std::abs(rod.y_m - middle_m_) <= config_.tolerance_m;
  const bool right = std::isfinite(rod.y_m) && rod.watch.fault() == RodFault::none && agrees;
  rod.right = right ? rod.right + 1 : 0;
  if (!right || (!readmit_ && static_cast<double>(rod.right) < return_ticks_)) return;
  rod.fault = RodFault::none;
}

void PositionVoter::transfer_to(std::size_t rod, bool controlling) noexcept {
  const double was_m = std::isfinite(rods_[rod].before_m) ? rods_[rod].before_m : rods_[rod].y_m;
  if (controlling && std::isfinite(given_m_)) bump_m_ = given_m_ - was_m;
  in_charge_ = rod;
  changed_ = true;
}

void PositionVoter::update(std::span<const RodReading> rods, double t_s, double command_V,
                           bool controlling) noexcept {
  changed_ = false;
  count_ = std::min(rods.size(), kMaxRods);
  read(rods, t_s, command_V);
  compare();
  if (!config_.present) return;
  if (!controlling) bump_m_ = 0.0;
  const double step_m = settings_.settle_mps * settings_.sample_time_s;
  bump_m_ -= std::clamp(bump_m_, -step_m, step_m);

  for (std::size_t i = 0; i < count_; ++i) judge(i, t_s, controlling);
  for (std::size_t i = 0; i < count_; ++i) readmit_if_right(i);
  readmit_ = false;
  for (std::size_t i = 0; i < count_; ++i) {
    const bool better = i < in_charge_ || rods_[in_charge_].fault != RodFault::none;
    if (i == in_charge_ || !better || other(kMaxRods, false, t_s) != i) continue;
    transfer_to(i, controlling);
    break;
  }
  const double y_m = rods_[in_charge_].y_m;
  given_m_ =
      controlling && std::isfinite(y_m) ? y_m + bump_m_ : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace monitor::control
