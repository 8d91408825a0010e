#include "estimator/fdi/alarm_book.h"

#include <utility>

namespace estimator::fdi {

const char* to_string(Severity severity) noexcept {
  switch (severity) {
    case Severity::ok:
      return "OK";
    case Severity::minor:
      return "MINOR";
    case Severity::major:
      return "MAJOR";
    case Severity::invalid:
      return "INVALID";
  }
  return "";
}

std::size_t AlarmBook::declare(Alarm alarm) {
  constexpr std::size_t kReason = 160;  // room for later reasons
  alarm.reason.reserve(kReason);
  alarms_.push_back(std::move(alarm));
  return alarms_.size() - 1;
}

const Alarm* AlarmBook::set(std::size_t number, const AlarmState& state) {
  Alarm& alarm = alarms_[number];
  alarm.value = state.value;
  alarm.std_error = state.std_error;
  if (alarm.severity == state.severity && alarm.direction == state.direction) return nullptr;
  const bool active = state.severity != Severity::ok;
  if (active != alarm.active) {
    alarm.first_up = active && active_count_ == 0;
    active_count_ = active ? active_count_ + 1 : active_count_ - 1;
  }
  alarm.active = active;
  alarm.severity = state.severity;
  alarm.direction = state.direction;
  alarm.tick = state.tick;
  alarm.reason.assign(state.reason);
  return &alarm;
}

const Alarm* AlarmBook::set_condition(std::string_view source, std::string_view name,
                                      Severity severity, bool active, std::string_view reason,
                                      std::int64_t tick) {
  std::size_t number = 0;
  while (number < alarms_.size() &&
         (alarms_[number].source != source || alarms_[number].name != name)) {
    ++number;
  }
  if (number == alarms_.size()) {
    if (!active) return nullptr;
    Alarm alarm;
    alarm.source = source;
    alarm.name = name;
    number = declare(std::move(alarm));
  }
  AlarmState state;
  state.severity = active ? severity : Severity::ok;
  state.tick = tick;
  state.reason = reason;
  return set(number, state);
}

void AlarmBook::reset() noexcept {
  for (Alarm& alarm : alarms_) {
    alarm.severity = Severity::ok;
    alarm.active = false;
    alarm.first_up = false;
    alarm.direction = 0;
    alarm.reason.clear();
  }
  active_count_ = 0;
}

}  // namespace estimator::fdi
