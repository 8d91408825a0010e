#include "tests/soak/alarm_watch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace soak {
namespace {

constexpr double kSurelyInside = 0.08;   // of the pressure
constexpr double kSurelyOutside = 0.20;  // of the pressure
constexpr std::size_t kChatterCount = 3;
constexpr double kChatter_s = 60.0;
constexpr double kTick_s = 0.005;

}  // namespace

AlarmWatch::AlarmWatch(std::string name, const std::vector<Fault>& faults, AlarmTimes times)
    : name_(std::move(name)) {
  phases_.push_back({0.0, Expected::off, 0});
  for (const Fault& fault : faults) {
    const double whole = std::abs(fault.factor - 1.0);
    const int direction = fault.factor > 1.0 ? 1 : -1;
    const double inside = kSurelyInside / whole;
    const double outside = kSurelyOutside / whole;
    phases_.push_back({fault.at_s + inside * fault.ramp_s, Expected::coming, direction});
    phases_.push_back(
        {fault.at_s + outside * fault.ramp_s + times.delay_s + kTick_s, Expected::on, direction});
    phases_.push_back(
        {fault.back_s + (1.0 - outside) * fault.back_ramp_s, Expected::going, direction});
    phases_.push_back({fault.back_s + (1.0 - inside) * fault.back_ramp_s + times.delay_s +
                           times.off_delay_s + kTick_s,
                       Expected::off, 0});
  }
}

void AlarmWatch::problem(double t_s, const std::string& what) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3f s: ", t_s);
  problems_.push_back(text + name_ + " " + what);
}

void AlarmWatch::enter(double t_s) {
  if (expected() == Expected::on && !active_) problem(t_s, "has not come");
  if (expected() != Expected::off) return;
  if (!active_) {
    chatters_ = false;
  } else if (chatters_) {
    held_until_s_ = t_s + kChatter_s;
  } else {
    problem(t_s, "has not gone");
  }
}

void AlarmWatch::advance(double t_s) {
  if (held_until_s_ > 0.0 && t_s > held_until_s_) {
    if (active_) problem(t_s, "has not gone, though it is quiet");
    chatters_ = false;
    held_until_s_ = 0.0;
  }
  while (phase_ + 1 < phases_.size() && phases_[phase_ + 1].from_s <= t_s) {
    ++phase_;
    enter(phases_[phase_].from_s);
  }
}

void AlarmWatch::see(double t_s, bool active, int direction) {
  advance(t_s);
  const Phase& now = phases_[phase_];
  if (active && direction != now.direction) {
    problem(t_s, std::string(direction > 0   ? "says high"
                             : direction < 0 ? "says low"
                                             : "has no direction") +
                     (now.direction > 0   ? ", the pressure is high"
                      : now.direction < 0 ? ", the pressure is low"
                                          : ", and nothing is wrong"));
  } else if (active && expected() == Expected::off) {
    problem(t_s, "came, and nothing is wrong");
  }
  if (!active && expected() == Expected::on) problem(t_s, "went, and the fault lasts");
  if (active && !active_) {
    ++comings_;
    came_s_.push_back(t_s);
    if (came_s_.size() > kChatterCount) came_s_.erase(came_s_.begin());
    if (came_s_.size() == kChatterCount && t_s - came_s_.front() <= kChatter_s) {
      chatters_ = true;
    }
    if (expected() == Expected::coming) {
      slowest_on_s_ = std::max(slowest_on_s_, t_s - now.from_s);
    }
  }
  if (!active && active_ && expected() == Expected::going) {
    slowest_off_s_ = std::max(slowest_off_s_, t_s - now.from_s);
  }
  active_ = active;
}

}  // namespace soak
