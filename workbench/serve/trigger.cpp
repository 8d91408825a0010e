#include "workbench/serve/trigger.h"

#include <cmath>

namespace workbench::serve {

const char* to_string(TriggerSettings::Mode mode) {
  switch (mode) {
    case TriggerSettings::Mode::normal:
      return "normal";
    case TriggerSettings::Mode::single:
      return "single";
    case TriggerSettings::Mode::off:
      break;
  }
  return "off";
}

const char* to_string(TriggerSettings::Edge edge) {
  switch (edge) {
    case TriggerSettings::Edge::falling:
      return "falling";
    case TriggerSettings::Edge::either:
      return "either";
    case TriggerSettings::Edge::rising:
      break;
  }
  return "rising";
}

bool Trigger::crosses(double value) const {
  const double level = settings_.level;
  const bool rises = value_ < level && value >= level;
  const bool falls = value_ > level && value <= level;
  switch (settings_.edge) {
    case TriggerSettings::Edge::rising:
      return rises;
    case TriggerSettings::Edge::falling:
      return falls;
    case TriggerSettings::Edge::either:
      break;
  }
  return rises || falls;
}

std::optional<Trigger::Span> Trigger::add(double t_s, double value) {
  if (settings_.mode == TriggerSettings::Mode::off || stopped_) return std::nullopt;
  if (t_s_ && t_s < *t_s_) {
    t_s_.reset();
    capturing_.reset();
    held_off_ = false;
  }
  if (held_off_ && t_s >= held_off_until_s_) held_off_ = false;
  // A comparison with a gap is never true.
  if (t_s_ && !capturing_ && !held_off_ && crosses(value)) {
    const double share = (settings_.level - value_) / (value - value_);
    const double at_s = *t_s_ + share * (t_s - *t_s_);
    const double before_s = settings_.before_ratio * settings_.window_s;
    capturing_ = {at_s - before_s, at_s, at_s - before_s + settings_.window_s};
  }
  t_s_ = t_s;
  value_ = value;
  if (!capturing_ || t_s < capturing_->to_s) return std::nullopt;
  const Span span = *capturing_;
  capturing_.reset();
  stopped_ = settings_.mode == TriggerSettings::Mode::single;
  held_off_until_s_ = span.to_s + settings_.hold_off_s;
  held_off_ = settings_.hold_off_s > 0.0;
  return span;
}

const char* Trigger::state() const {
  if (settings_.mode == TriggerSettings::Mode::off) return "off";
  if (stopped_) return "stopped";
  if (capturing_) return "capturing";
  return held_off_ ? "held off" : "waiting";
}

}  // namespace workbench::serve
