// Persistence of alarm states: as a list across restarts, bit for bit in a snapshot.
#include <algorithm>
#include <utility>

#include "estimator/fdi/alarm_book.h"

namespace estimator::fdi {
namespace {

/// An alarm acknowledged before the restart stays acknowledged when its cause is found again within
/// this time.
constexpr double kResume_s = 60.0;

void serialize_fault_name(StateArchive& archive, Alarm& alarm) {
  constexpr std::uint64_t kMostNames = 1000;
  archive.text(alarm.parameter);
  auto names = static_cast<std::uint64_t>(alarm.ambiguity_group.size());
  archive.value(names);
  if (names > kMostNames) archive.fail();
  if (!archive.good()) return;
  alarm.ambiguity_group.resize(static_cast<std::size_t>(names));
  for (std::string& name : alarm.ambiguity_group) archive.text(name);
}

}  // namespace

std::vector<PersistedAlarm> AlarmBook::persisted_alarms() const {
  std::vector<PersistedAlarm> persisted;
  for (const Alarm& alarm : alarms_) {
    if (alarm.state() == AlarmState::normal) continue;
    PersistedAlarm saved;
    saved.source = alarm.source;
    saved.name = alarm.name;
    saved.reason = alarm.reason;
    saved.acknowledged_by = alarm.acknowledged_by;
    saved.shelved_by = alarm.shelved_by;
    saved.severity = alarm.severity;
    saved.direction = alarm.direction;
    saved.active = alarm.active;
    saved.latched = alarm.latched;
    saved.acknowledged = alarm.acknowledged;
    saved.first_up = alarm.first_up;
    saved.value = alarm.value;
    saved.shelved_for_s = shelved_for_s(alarm);
    saved.came_utc_us = alarm.came_utc_us;
    saved.times = alarm.times;
    persisted.push_back(std::move(saved));
  }
  return persisted;
}

void AlarmBook::restore(const std::vector<PersistedAlarm>& alarms) {
  for (const PersistedAlarm& saved : alarms) {
    std::size_t number = find(saved.source + "." + saved.name);
    if (number == kNone && (saved.source == "loop" || saved.source == "recorder")) {
      Alarm alarm;
      alarm.source = saved.source;
      alarm.name = saved.name;
      alarm.rules = condition_rules_;
      number = declare(std::move(alarm));
    }
    if (number == kNone) continue;
    Alarm& alarm = alarms_[number];
    Memory& memory = memories_[number];
    alarm.reason = saved.reason;
    alarm.came_utc_us = saved.came_utc_us;
    alarm.times = saved.times;
    alarm.first_up = saved.first_up && !saved.acknowledged;
    alarm.value = saved.value;
    alarm.acknowledged_by = saved.acknowledged_by;
    const bool needs_a_person = alarm.rules.acknowledge || alarm.rules.latch;
    alarm.acknowledged = saved.acknowledged || !needs_a_person;
    // The cause is not known yet: only a latch keeps the alarm active.
    if (saved.active && alarm.rules.latch && !alarm.acknowledged) {
      alarm.active = alarm.latched = true;
      alarm.severity = saved.severity;
      alarm.direction = saved.direction;
    }
    if (saved.active) {
      memory.resumes_known = true;
      memory.resume_until = tick_ + ticks(kResume_s);
      if (alarm.acknowledged) memory.seen = saved.severity;
    }
    if (saved.shelved_for_s > 0.0 && alarm.rules.shelve_limit_s > 0.0) {
      alarm.shelved = true;
      alarm.shelved_by = saved.shelved_by;
      alarm.shelved_until =
          tick_ + ticks(std::min(saved.shelved_for_s, alarm.rules.shelve_limit_s));
      memory.timed = true;
    }
  }
  recount();
}

void AlarmBook::inherit(const AlarmBook& before) {
  tick_ = before.tick_;
  utc_us_ = before.utc_us_;
  changes_ = before.changes_ + 1;
  for (std::size_t i = 0; i < before.alarms_.size(); ++i) {
    const Alarm& from = before.alarms_[i];
    const std::size_t number = find(from.source + "." + from.name);
    if (number == kNone) continue;
    Alarm& to = alarms_[number];
    Memory& memory = memories_[number];
    Alarm was = to;
    to = from;
    to.quantity = was.quantity;
    if (!was.named_at_run_time || !from.named_at_run_time) {
      to.parameter = was.parameter;
      to.ambiguity_group = was.ambiguity_group;
      to.confidence = was.confidence;
    }
    to.named_at_run_time = was.named_at_run_time;
    to.falls_with_parameter = was.falls_with_parameter;
    to.guidance = was.guidance;
    to.low = was.low;
    to.high = was.high;
    to.rules = was.rules;
    Memory mine = std::move(memory);
    memory = before.memories_[i];
    memory.comings = std::move(mine.comings);
    memory.arrivals = std::move(mine.arrivals);
    memory.timed = true;
    if (to.shelved) {
      to.shelved_until = std::min(to.shelved_until, tick_ + ticks(to.rules.shelve_limit_s));
    }
  }
  recount();
}

void AlarmBook::adopt_conditions(const AlarmBook& before) {
  for (const Alarm& from : before.alarms_) {
    if (from.on_quantity() || find(from.source + "." + from.name) != kNone) continue;
    Alarm alarm;
    alarm.source = from.source;
    alarm.name = from.name;
    alarm.rules = condition_rules_;
    declare(std::move(alarm));
  }
}

void AlarmBook::force_state(std::size_t number, const Alarm& recorded) {
  Alarm& alarm = alarms_[number];
  alarm.active = recorded.active;
  alarm.severity = recorded.severity;
  alarm.direction = recorded.direction;
  alarm.latched = recorded.latched;
  alarm.acknowledged = recorded.acknowledged;
  alarm.shelved = recorded.shelved;
  alarm.first_up = recorded.first_up;
  alarm.tick = recorded.tick;
  alarm.value = recorded.value;
  alarm.reason = recorded.reason;
  memories_[number].timed = false;
  recount();
  ++changes_;
}

void AlarmBook::serialize(StateArchive& archive) {
  constexpr std::size_t kMostAlarms = 10000;
  auto size = static_cast<std::uint64_t>(alarms_.size());
  archive.value(size);
  if (size > kMostAlarms) archive.fail();
  for (std::size_t i = 0; archive.good() && i < size; ++i) {
    Alarm alarm;
    if (i < alarms_.size()) alarm = alarms_[i];
    for (std::string* text :
         {&alarm.source, &alarm.name, &alarm.reason, &alarm.acknowledged_by, &alarm.shelved_by}) {
      archive.text(*text);
    }
    archive.value(alarm.rules);
    if (i == alarms_.size() && archive.good()) declare(alarm);
    if (!archive.good() || i >= alarms_.size()) break;
    if (alarm.source != alarms_[i].source || alarm.name != alarms_[i].name) return archive.fail();
    Alarm& to = alarms_[i];
    to.reason = alarm.reason;
    to.acknowledged_by = alarm.acknowledged_by;
    to.shelved_by = alarm.shelved_by;
    for (bool* flag :
         {&to.active, &to.first_up, &to.latched, &to.acknowledged, &to.shelved, &to.chattering}) {
      archive.value(*flag);
    }
    for (std::int64_t* number :
         {&to.tick, &to.shelved_until, &to.came_tick, &to.came_utc_us, &to.times}) {
      archive.value(*number);
    }
    for (double* number : {&to.value, &to.std_error, &to.low, &to.high, &to.confidence}) {
      archive.value(*number);
    }
    if (to.named_at_run_time) serialize_fault_name(archive, to);
    archive.value(to.severity);
    archive.value(to.direction);
    Memory& memory = memories_[i];
    for (Recent* recent : {&memory.comings, &memory.arrivals}) {
      archive.fixed(recent->ticks);
      archive.value(recent->next);
      archive.value(recent->filled);
      if (recent->next > recent->ticks.size()) archive.fail();
    }
    for (bool* flag : {&memory.admitted, &memory.timed, &memory.resumes_known}) {
      archive.value(*flag);
    }
    for (std::int64_t* number : {&memory.turned_tick, &memory.resume_until}) archive.value(*number);
    archive.value(memory.severity);
    archive.value(memory.direction);
    archive.value(memory.seen);
  }
  archive.value(tick_);
  archive.value(utc_us_);
  archive.value(changes_);
  recount();
}

}  // namespace estimator::fdi
