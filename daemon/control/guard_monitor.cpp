#include "daemon/control/guard_monitor.h"

#include <algorithm>
#include <cmath>

#include "config/signals/nan.h"
#include "daemon/control/position_voter.h"

namespace monitor::control {
namespace {

/// Larger than any rounding error of times on the grid.
constexpr double kRounding_s = 1e-9;
/// A rod that returns into its travel limits may first move this much further out (noise, starting
/// jerk).
constexpr double kReturnMargin_m = 1e-3;

using config::signals::kNaN;

double upper_limit(const GuardConfig& config) noexcept {
  switch (config.which()) {
    case GuardKind::travel:
      return config.high_m;
    case GuardKind::following:
    case GuardKind::jump:
      return config.limit_m;
    case GuardKind::speed:
      return config.limit_mps;
    case GuardKind::stale:
      return config.age_s;
    case GuardKind::disagree:
      return config.tolerance_m;
    case GuardKind::pressure:
      return config.high_Pa;
    case GuardKind::chambers:
      return config.tolerance_Pa;
    default:
      return kNaN;
  }
}

double lower_limit(const GuardConfig& config) noexcept {
  switch (config.which()) {
    case GuardKind::travel:
      return config.low_m;
    case GuardKind::pressure:
      return config.low_Pa;
    default:
      return kNaN;
  }
}

double config::signals::Pressures::*channel_of(const GuardConfig& config) noexcept {
  if (config.channel == "pressure_in") return &config::signals::Pressures::in_Pa;
  if (config.channel == "pressure_out") return &config::signals::Pressures::out_Pa;
  return &config::signals::Pressures::supply_Pa;
}

/// By how much the chamber pressures leave 0 to the supply pressure; NaN: not known.
double excess_Pa(const config::signals::Pressures& pressures) noexcept {
  if (!pressures.chambers()) return kNaN;
  const double below = -std::min(pressures.in_Pa, pressures.out_Pa);
  if (std::isnan(pressures.supply_Pa)) return below;
  return std::max(below, std::max(pressures.in_Pa, pressures.out_Pa) - pressures.supply_Pa);
}

}  // namespace

Guard::Guard(const GuardConfig& config)
    : kind_(config.which()),
      action_(action_of(config.action)),
      channel_(channel_of(config)),
      time_s_(config.time_s),
      low_(lower_limit(config)),
      high_(upper_limit(config)),
      braking_mps2_(config.braking_mps2),
      least_m_(config.least_m),
      command_V_(config.command_V),
      low_now_m_(low_),
      high_now_m_(high_) {}

void Guard::set(bool active, double value) noexcept {
  rose_ = active && !active_;
  active_ = active;
  value_ = value;
}

void Guard::take_limits(const Guard& other) noexcept {
  // While the rod returns from outside, its limits are wider.
  low_now_m_ = low_now_m_ < low_ ? std::min(low_now_m_, other.low_) : other.low_;
  high_now_m_ = high_now_m_ > high_ ? std::max(high_now_m_, other.high_) : other.high_;
  time_s_ = other.time_s_;
  low_ = other.low_;
  high_ = other.high_;
  braking_mps2_ = other.braking_mps2_;
  least_m_ = other.least_m_;
  command_V_ = other.command_V_;
}

void Guard::start(double y_m) noexcept {
  if (static_cast<std::size_t>(kind_) < kBuiltIn) return;
  active_ = false;
  since_s_ = kNaN;
  low_now_m_ = std::min(low_, y_m - kReturnMargin_m);
  high_now_m_ = std::max(high_, y_m + kReturnMargin_m);
}

bool Guard::outside_travel(double y_m, double speed_mps) noexcept {
  if (y_m >= low_) low_now_m_ = low_;
  if (y_m <= high_) high_now_m_ = high_;
  value_ = y_m + speed_mps * std::abs(speed_mps) / (2.0 * braking_mps2_);
  return value_ < low_now_m_ || value_ > high_now_m_;
}

bool Guard::frozen(const GuardInputs& inputs) noexcept {
  const double sign =
      std::abs(inputs.command_V) > command_V_ ? std::copysign(1.0, inputs.command_V) : 0.0;
  const double moved_m = std::abs(inputs.y_m - anchor_m_);
  if (sign == 0.0 || sign != sign_ || std::isnan(since_s_) || moved_m >= least_m_) {
    since_s_ = inputs.t_s;
    anchor_m_ = inputs.y_m;
    sign_ = sign;
    return false;
  }
  value_ = moved_m;
  return inputs.t_s - since_s_ >= time_s_ - kRounding_s;
}

void Guard::lasts(bool condition, double t_s) noexcept {
  if (!condition) since_s_ = kNaN;
  if (condition && std::isnan(since_s_)) since_s_ = t_s;
  set(condition && t_s - since_s_ >= time_s_ - kRounding_s, value_);
}

void Guard::watch(const GuardInputs& inputs, double dy_m, double dt_s, double period_s) noexcept {
  rose_ = false;
  const bool known = !std::isnan(inputs.y_m);
  const double speed_mps = std::isnan(dy_m) ? 0.0 : dy_m / dt_s;
  switch (kind_) {
    case GuardKind::travel:
      if (known) lasts(outside_travel(inputs.y_m, speed_mps), inputs.t_s);
      break;
    case GuardKind::following:
      value_ = std::abs(inputs.reference_m - inputs.y_m);
      lasts(value_ > high_, inputs.t_s);
      break;
    case GuardKind::speed:
      value_ = std::abs(speed_mps);
      if (known) lasts(value_ > high_, inputs.t_s);
      break;
    case GuardKind::stale:
      value_ = inputs.age_s;
      lasts(inputs.called_stale || value_ > high_, inputs.t_s);
      break;
    case GuardKind::frozen:
      if (known) set(frozen(inputs), value_);
      break;
    case GuardKind::jump: {
      const double periods = std::max(1.0, std::round(dt_s / period_s));
      if (known && !std::isnan(dy_m)) set(std::abs(dy_m) > high_ * periods, std::abs(dy_m));
      break;
    }
    case GuardKind::saturated:
      value_ = inputs.command_V;
      lasts(inputs.saturated, inputs.t_s);
      break;
    case GuardKind::disagree:
      value_ = inputs.spare_difference_m;
      lasts(value_ > high_, inputs.t_s);
      break;
    case GuardKind::pressure:
      value_ = inputs.pressures.*channel_;
      lasts(!std::isnan(inputs.reference_m) && (value_ < low_ || value_ > high_), inputs.t_s);
      break;
    case GuardKind::chambers:
      value_ = excess_Pa(inputs.pressures);
      lasts(!std::isnan(inputs.reference_m) && value_ > high_, inputs.t_s);
      break;
    case GuardKind::transducer:
      value_ = inputs.pressures.*channel_;
      lasts(std::isnan(value_), inputs.t_s);
      break;
    default:
      break;
  }
}

GuardMonitor::GuardMonitor(const std::vector<GuardConfig>& guards, double sample_time_s)
    : guards_(guards.begin(), guards.end()), sample_time_s_(sample_time_s) {}

GuardTrip GuardMonitor::set(GuardKind built_in, bool active, double value) noexcept {
  const auto index = static_cast<std::size_t>(built_in);
  guards_[index].set(active, value);
  return active ? GuardTrip{guards_[index].action(), static_cast<int>(index)} : GuardTrip{};
}

GuardTrip GuardMonitor::watch(const GuardInputs& inputs, const SensorWatch* sensor) noexcept {
  if (inputs.other_sensor) last_.forget();
  GuardTrip trip;
  if (sensor != nullptr) {
    for (const SensorWatch::Watched& each : sensor->guards()) guards_[each.number] = each.guard;
  }
  for (std::size_t i = kBuiltIn; i < guards_.size(); ++i) {
    Guard& guard = guards_[i];
    if (sensor == nullptr || !watches_a_sensor(guard.kind())) {
      guard.watch(inputs, last_.dy_m(inputs), last_.dt_s(inputs), sample_time_s_);
    }
    if (guard.rose() && guard.action() > trip.action) {
      trip = {guard.action(), static_cast<int>(i)};
    }
  }
  last_.update(inputs);
  return trip;
}

void GuardMonitor::take_limits(const std::vector<Guard>& guards) noexcept {
  for (std::size_t i = 0; i < guards_.size() && i < guards.size(); ++i) {
    guards_[i].take_limits(guards[i]);
  }
}

void GuardMonitor::start(double y_m) noexcept {
  for (Guard& guard : guards_) guard.start(y_m);
}

int GuardMonitor::obstacle() const noexcept {
  for (std::size_t i = 0; i < guards_.size(); ++i) {
    const GuardKind kind = guards_[i].kind();
    const bool forbids = kind == GuardKind::e_stop || kind == GuardKind::missing ||
                         kind == GuardKind::bus_lost || kind == GuardKind::stale ||
                         kind == GuardKind::disagree;
    if (forbids && guards_[i].active() && guards_[i].action() > Action::indicate) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

}  // namespace monitor::control
