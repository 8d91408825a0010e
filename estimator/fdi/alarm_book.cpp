#include "estimator/fdi/alarm_book.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace estimator::fdi {

std::int64_t AlarmBook::ticks(double time_s) const noexcept {
  return std::llround(time_s / sample_time_s_);
}

bool AlarmBook::Recent::add(std::int64_t tick, std::int64_t window) noexcept {
  if (ticks.empty()) return false;
  ticks[next] = tick;
  next = (next + 1) % ticks.size();
  filled = std::min(filled + 1, ticks.size());
  return filled == ticks.size() && tick - ticks[next] <= window;
}

std::size_t AlarmBook::declare(Alarm alarm) {
  constexpr std::size_t kReason = 512;  // room for later reasons
  alarm.reason.reserve(kReason);
  Memory memory;
  memory.comings.ticks.resize(static_cast<std::size_t>(alarm.rules.count));
  memory.arrivals.ticks.resize(static_cast<std::size_t>(alarm.rules.chatter_count));
  alarms_.push_back(std::move(alarm));
  memories_.push_back(std::move(memory));
  return alarms_.size() - 1;
}

const Alarm* AlarmBook::set(std::size_t number, const AlarmInput& input) {
  Alarm& alarm = alarms_[number];
  Memory& memory = memories_[number];
  alarm.value = input.value;
  alarm.std_error = input.std_error;
  const bool was_out = memory.severity != Severity::ok;
  const bool is_out = input.severity != Severity::ok;
  memory.severity = input.severity;
  memory.direction = input.direction;
  if (is_out != was_out) {
    memory.turned_tick = input.tick;
    memory.admitted = is_out && memory.comings.add(input.tick, ticks(alarm.rules.count_window_s));
  }
  const bool renamed = is_out && input.fault != nullptr && name(alarm, *input.fault);
  const Alarm* changed = settle(number, input.tick, input.reason);
  if (changed != nullptr || !renamed || !alarm.active) return changed;
  alarm.tick = input.tick;
  alarm.reason.assign(input.reason);
  ++changes_;
  return &alarm;
}

bool AlarmBook::name(Alarm& alarm, const FaultName& fault) {
  alarm.confidence = fault.confidence;
  if (alarm.parameter == fault.parameter &&
      std::equal(alarm.ambiguity_group.begin(), alarm.ambiguity_group.end(), fault.group.begin(),
                 fault.group.end())) {
    return false;
  }
  alarm.parameter.assign(fault.parameter);
  alarm.ambiguity_group.assign(fault.group.begin(), fault.group.end());
  return true;
}

const Alarm* AlarmBook::settle(std::size_t number, std::int64_t tick, std::string_view reason) {
  Alarm& alarm = alarms_[number];
  Memory& memory = memories_[number];
  const AlarmRules& rules = alarm.rules;
  const bool out = memory.severity != Severity::ok;
  const std::int64_t since = tick - memory.turned_tick;
  if (out && !memory.admitted && since >= ticks(rules.count_window_s)) memory.admitted = true;
  if (!out && alarm.chattering && since >= ticks(rules.chatter_window_s)) alarm.chattering = false;

  const bool wanted = out && memory.admitted;
  const bool held = !wanted && alarm.active && alarm.chattering;
  const bool latched = !wanted && !held && alarm.active && rules.latch && !alarm.acknowledged;
  const bool active = wanted || held || latched;
  memory.timed = alarm.shelved || alarm.chattering || (out && !memory.admitted);

  const Severity severity = wanted ? memory.severity : active ? alarm.severity : Severity::ok;
  const std::int8_t direction = wanted   ? memory.direction
                                : active ? alarm.direction
                                         : std::int8_t{0};
  if (active == alarm.active && severity == alarm.severity && direction == alarm.direction &&
      latched == alarm.latched) {
    if (!active && out) alarm.reason.assign(reason);  // published once the alarm is raised
    return nullptr;
  }
  if (active && !alarm.active) come(number, tick);
  alarm.active = active;
  alarm.latched = latched;
  alarm.severity = severity;
  alarm.direction = direction;
  alarm.tick = tick;
  if (!reason.empty() || !active) alarm.reason.assign(reason);
  if (alarm.chattering && active) alarm.reason.append("; chattering: active until quiet");
  // A severity above the acknowledged one must be acknowledged again.
  if (active && severity > memory.seen && (rules.acknowledge || rules.latch)) {
    alarm.acknowledged = false;
  }
  if (!alarm.stands()) alarm.first_up = false;
  recount();
  ++changes_;
  return &alarm;
}

void AlarmBook::come(std::size_t number, std::int64_t tick) {
  Alarm& alarm = alarms_[number];
  Memory& memory = memories_[number];
  const bool resumes = memory.resumes_known && tick <= memory.resume_until;
  if (!resumes) {
    if (!alarm.stands()) alarm.first_up = standing_ == 0 && !alarm.shelved;
    memory.seen = Severity::ok;
    alarm.came_tick = tick;
    alarm.came_utc_us = utc_us_;
    alarm.acknowledged_by.clear();
    ++alarm.times;
  }
  memory.resumes_known = false;
  if (memory.arrivals.add(tick, ticks(alarm.rules.chatter_window_s))) alarm.chattering = true;
  memory.timed = memory.timed || alarm.chattering;
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
    alarm.rules = condition_rules_;
    number = declare(std::move(alarm));
  }
  AlarmInput input;
  input.severity = active ? severity : Severity::ok;
  input.tick = tick;
  input.reason = reason;
  return set(number, input);
}

void AlarmBook::pass_to(std::int64_t tick, std::int64_t utc_us) noexcept {
  if (tick < tick_) {
    for (std::size_t i = 0; i < alarms_.size(); ++i) {
      Memory& memory = memories_[i];
      memory.turned_tick = tick;
      memory.comings.filled = 0;
      memory.arrivals.filled = 0;
      alarms_[i].shelved_until += tick - tick_;
      memory.resume_until += tick - tick_;
    }
  }
  tick_ = tick;
  utc_us_ = utc_us;
}

const Alarm* AlarmBook::expire(std::size_t number) {
  Alarm& alarm = alarms_[number];
  const bool off_the_shelf = alarm.shelved && tick_ >= alarm.shelved_until;
  if (off_the_shelf) {
    alarm.shelved = false;
    alarm.shelved_by.clear();
    alarm.tick = tick_;
    recount();
    ++changes_;
  }
  const bool out = memories_[number].severity != Severity::ok;
  const Alarm* settled =
      settle(number, tick_, out ? std::string_view(alarm.reason) : "quiet for long enough");
  return off_the_shelf ? &alarm : settled;
}

AlarmActionResult AlarmBook::acknowledge(std::size_t number, std::string_view who) {
  Alarm& alarm = alarms_[number];
  if (alarm.acknowledged) return {nullptr, "nothing to acknowledge"};
  alarm.acknowledged = true;
  alarm.acknowledged_by.assign(who);
  memories_[number].seen = alarm.severity;
  alarm.tick = tick_;
  if (settle(number, tick_, "acknowledged") == nullptr) {
    if (!alarm.stands()) alarm.first_up = false;
    recount();
    ++changes_;
  }
  return {&alarm};
}

AlarmActionResult AlarmBook::shelve(std::size_t number, double time_s, std::string_view who) {
  Alarm& alarm = alarms_[number];
  const double most_s = alarm.rules.shelve_limit_s;
  if (!(most_s > 0.0)) return {nullptr, "shelving is not allowed (shelve_limit_s = 0)"};
  if (!(time_s > 0.0 && time_s <= most_s)) {
    return {nullptr, "shelving is limited to " + std::to_string(std::llround(most_s)) +
                         " s (shelve_limit_s)"};
  }
  alarm.shelved = true;
  alarm.shelved_until = tick_ + std::max<std::int64_t>(ticks(time_s), 1);
  alarm.shelved_by.assign(who);
  alarm.tick = tick_;
  memories_[number].timed = true;
  recount();
  ++changes_;
  return {&alarm};
}

AlarmActionResult AlarmBook::unshelve(std::size_t number) {
  Alarm& alarm = alarms_[number];
  if (!alarm.shelved) return {nullptr, "not shelved"};
  alarm.shelved_until = tick_;
  expire(number);
  return {&alarm};
}

std::size_t AlarmBook::find(std::string_view id) const noexcept {
  std::size_t by_name = kNone;
  bool unique = true;
  for (std::size_t i = 0; i < alarms_.size(); ++i) {
    const Alarm& alarm = alarms_[i];
    const std::size_t dot = alarm.source.size();
    if (id.size() == dot + 1 + alarm.name.size() && id.substr(0, dot) == alarm.source &&
        id[dot] == '.' && id.substr(dot + 1) == alarm.name) {
      return i;
    }
    if (alarm.name != id) continue;
    unique = by_name == kNone;
    by_name = i;
  }
  return unique ? by_name : kNone;
}

double AlarmBook::shelved_for_s(const Alarm& alarm) const noexcept {
  if (!alarm.shelved) return 0.0;
  return static_cast<double>(std::max<std::int64_t>(alarm.shelved_until - tick_, 0)) *
         sample_time_s_;
}

void AlarmBook::recount() noexcept {
  active_count_ = 0;
  standing_ = 0;
  for (const Alarm& alarm : alarms_) {
    active_count_ += alarm.annunciated() ? 1 : 0;
    standing_ += alarm.stands() && !alarm.shelved ? 1 : 0;
  }
}

void AlarmBook::reset() noexcept {
  for (std::size_t i = 0; i < alarms_.size(); ++i) {
    Alarm& alarm = alarms_[i];
    Memory& memory = memories_[i];
    alarm.severity = memory.severity = memory.seen = Severity::ok;
    alarm.active = alarm.latched = alarm.first_up = alarm.shelved = alarm.chattering = false;
    alarm.acknowledged = true;
    alarm.direction = memory.direction = 0;
    alarm.reason.clear();
    if (alarm.named_at_run_time) {
      alarm.parameter.clear();
      alarm.ambiguity_group.clear();
      alarm.confidence = kNaN;
    }
    memory.admitted = memory.timed = memory.resumes_known = false;
    memory.comings.filled = memory.arrivals.filled = 0;
  }
  active_count_ = standing_ = 0;
}

}  // namespace estimator::fdi
