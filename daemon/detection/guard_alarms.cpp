#include "daemon/detection/guard_alarms.h"

namespace monitor::detection {

using control::Action;
using estimator::fdi::Alarm;
using estimator::fdi::Severity;

namespace {

const char* consequence(Action action) {
  switch (action) {
    case Action::hold:
      return ": in RUN the reference is held until start";
    case Action::ramp:
      return ": in RUN the command ramps to null, then DISARMED";
    case Action::disarm:
      return ": DISARMED";
    case Action::latch:
      return ": in RUN LATCHED until reset";
    default:
      return "";
  }
}

}  // namespace

GuardAlarms::GuardAlarms(const std::vector<control::GuardConfig>& guards,
                         estimator::fdi::AlarmBook& book)
    : guards_(guards) {
  declare_in(book);
}

void GuardAlarms::declare_in(estimator::fdi::AlarmBook& book) {
  book_ = &book;
  entries_.clear();
  for (const control::GuardConfig& guard : guards_) {
    const control::GuardKind kind = guard.which();
    const control::Guard limits(guard);
    Alarm alarm;
    alarm.source = "loop";
    alarm.name = guard.id;
    alarm.quantity = control::to_string(kind);
    alarm.guidance = guard.guidance.empty() ? control::guidance_of(kind) : guard.guidance;
    alarm.rules = book_->condition_rules();
    alarm.low = limits.low();
    alarm.high = limits.high();
    const Action action = control::action_of(guard.action);
    const Severity severity = action == Action::indicate ? Severity::minor : Severity::major;
    entries_.push_back({book_->declare(std::move(alarm)), severity,
                        std::string(control::reason_of(kind)) + consequence(action)});
  }
}

void GuardAlarms::report(rt::GuardStatus& status, std::int64_t tick,
                         const std::function<void(const Alarm&)>& changed) {
  const std::uint32_t now = status.take_raised() | status.active();
  if (now == published_) return;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const std::uint32_t bit = 1U << i;
    if (((now ^ published_) & bit) == 0) continue;
    const bool active = (now & bit) != 0;
    estimator::fdi::AlarmInput state;
    state.severity = active ? entries_[i].severity : Severity::ok;
    state.tick = tick;
    state.value = status.value(i);
    if (active) {
      const Alarm& limits = book_->alarm(entries_[i].number);
      state.reason = entries_[i].reason;
      state.direction = state.value > limits.high ? 1 : state.value < limits.low ? -1 : 0;
    }
    if (const Alarm* alarm = book_->set(entries_[i].number, state)) changed(*alarm);
  }
  published_ = now;
}

}  // namespace monitor::detection
