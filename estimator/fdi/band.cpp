#include "estimator/fdi/band.h"

#include <cmath>

namespace estimator::fdi {
namespace {

/// Delays are whole ticks on a grid of doubles.
constexpr double kTimeRounding_s = 1e-6;

}  // namespace

void BandConfig::visit(config::schema::Visitor& v) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  v.text({"id", "the alarm's name", true}, id);
  v.text({"quantity", "monitored quantity: ESTIMATOR.b1, sample.y_m, ...", true}, quantity);
  v.number({"low", "alarm below, in the quantity's unit"}, low);
  v.number({"high", "alarm above, in the quantity's unit"}, high);
  v.number({"hysteresis", "distance inside the band at which the alarm clears"}, hysteresis,
           {0.0, kInfinity});
  v.number({"on_delay_s", "time outside the band before the alarm is raised"}, on_delay_s,
           {0.0, 3600.0});
  v.number({"off_delay_s", "time inside the band before the alarm clears"}, off_delay_s,
           {0.0, 3600.0});
  v.number({"invalid_delay_s", "time without a valid value before INVALID"}, invalid_delay_s,
           {0.0, 3600.0});
  v.choice({"severity", "severity of the alarm"}, severity, {"minor", "major"});
  v.text({"parameter", "the physical parameter meant"}, parameter);
  v.boolean({"falls_with_parameter", "the quantity falls when the parameter rises"},
            falls_with_parameter);
  v.texts({"ambiguity_group", "parameters that this quantity cannot separate"}, ambiguity_group);
  v.text({"guidance", "advice to the operator"}, guidance);
  rules.visit(v);
}

BandState::BandState(const BandConfig& config)
    : low_(config.low),
      high_(config.high),
      hysteresis_(config.hysteresis),
      on_delay_s_(config.on_delay_s),
      off_delay_s_(config.off_delay_s),
      invalid_delay_s_(config.invalid_delay_s),
      alarm_(config.severity == "minor" ? Severity::minor : Severity::major) {}

int BandState::wanted(double value) const noexcept {
  if (value > high_) return 1;
  if (value < low_) return -1;
  if (direction_ > 0 && value > high_ - hysteresis_) return 1;
  if (direction_ < 0 && value < low_ + hysteresis_) return -1;
  return 0;
}

BandState::Result BandState::result() const noexcept {
  if (invalid_) return {Severity::invalid, 0};
  return {direction_ == 0 ? Severity::ok : alarm_, direction_};
}

BandState::Result BandState::update(double value, double t_s) noexcept {
  if (std::isnan(value)) return update_invalid(t_s);
  missing_ = false;
  invalid_ = false;
  const int direction = wanted(value);
  if (direction == direction_) {
    pending_ = direction_;
    return result();
  }
  if (pending_ != direction || t_s < pending_since_s_) {
    pending_ = direction;
    pending_since_s_ = t_s;
  }
  const double delay_s = direction == 0 ? off_delay_s_ : on_delay_s_;
  if (t_s - pending_since_s_ >= delay_s - kTimeRounding_s) direction_ = direction;
  return result();
}

BandState::Result BandState::update_invalid(double t_s) noexcept {
  if (!missing_ || t_s < missing_since_s_) {
    missing_ = true;
    missing_since_s_ = t_s;
  }
  pending_ = direction_;
  if (t_s - missing_since_s_ >= invalid_delay_s_ - kTimeRounding_s) invalid_ = true;
  return result();
}

BandState::Result BandState::rest() noexcept {
  invalid_ = false;
  missing_ = false;
  pending_ = direction_;
  return result();
}

void BandState::reset() noexcept {
  invalid_ = false;
  missing_ = false;
  direction_ = 0;
  pending_ = 0;
}

void BandState::inherit(const BandState& before) noexcept {
  invalid_ = before.invalid_;
  direction_ = before.direction_;
  pending_ = before.pending_;
  pending_since_s_ = before.pending_since_s_;
  missing_ = before.missing_;
  missing_since_s_ = before.missing_since_s_;
}

}  // namespace estimator::fdi
