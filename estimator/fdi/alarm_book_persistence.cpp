// How the lives of a book outlast it: as a list after a restart, as every bit in a snapshot.
#include <algorithm>
#include <utility>

#include "estimator/fdi/alarm_book.h"

namespace estimator::fdi {
namespace {

/// An alarm acknowledged before the restart stays so when its cause is found again this soon.
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

std::vector<PersistedAlarm> AlarmBook::lives() const {
  std::vector<PersistedAlarm> lives;
  for (const Alarm& alarm : alarms_) {
    if (alarm.state() == AlarmState::normal) continue;
    PersistedAlarm life;
    life.source = alarm.source;
    life.name = alarm.name;
    life.reason = alarm.reason;
    life.acknowledged_by = alarm.acknowledged_by;
    life.shelved_by = alarm.shelved_by;
    life.severity = alarm.severity;
    life.direction = alarm.direction;
    life.active = alarm.active;
    life.latched = alarm.latched;
    life.acknowledged = alarm.acknowledged;
    life.first_up = alarm.first_up;
    life.value = alarm.value;
    life.shelved_for_s = shelved_for_s(alarm);
    life.came_utc_us = alarm.came_utc_us;
    life.times = alarm.times;
    lives.push_back(std::move(life));
  }
  return lives;
}

void AlarmBook::restore(const std::vector<PersistedAlarm>& lives) {
  for (const PersistedAlarm& life : lives) {
    std::size_t number = find(life.source + "." + life.name);
    if (number == kNone && (life.source == "loop" || life.source == "recorder")) {
      Alarm alarm;
      alarm.source = life.source;
      alarm.name = life.name;
      alarm.rules = condition_rules_;
      number = declare(std::move(alarm));
    }
    if (number == kNone) continue;
    Alarm& alarm = alarms_[number];
    Memory& memory = memories_[number];
    alarm.reason = life.reason;
    alarm.came_utc_us = life.came_utc_us;
    alarm.times = life.times;
    alarm.first_up = life.first_up && !life.acknowledged;
    alarm.value = life.value;
    alarm.acknowledged_by = life.acknowledged_by;
    const bool needs_a_person = alarm.rules.acknowledge || alarm.rules.latch;
    alarm.acknowledged = life.acknowledged || !needs_a_person;
    // Its cause is not known yet: only a latch makes it active.
    if (life.active && alarm.rules.latch && !alarm.acknowledged) {
      alarm.active = alarm.latched = true;
      alarm.severity = life.severity;
      alarm.direction = life.direction;
    }
    if (life.active) {
      memory.resumes_known = true;
      memory.resume_until = tick_ + ticks(kResume_s);
      if (alarm.acknowledged) memory.seen = life.severity;
    }
    if (life.shelved_for_s > 0.0 && alarm.rules.shelve_limit_s > 0.0) {
      alarm.shelved = true;
      alarm.shelved_by = life.shelved_by;
      alarm.shelved_until = tick_ + ticks(std::min(life.shelved_for_s, alarm.rules.shelve_limit_s));
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

void AlarmBook::show(std::size_t number, const Alarm& told) {
  Alarm& alarm = alarms_[number];
  alarm.active = told.active;
  alarm.severity = told.severity;
  alarm.direction = told.direction;
  alarm.latched = told.latched;
  alarm.acknowledged = told.acknowledged;
  alarm.shelved = told.shelved;
  alarm.first_up = told.first_up;
  alarm.tick = told.tick;
  alarm.value = told.value;
  alarm.reason = told.reason;
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
    for (std::int64_t* number : {&memory.turned_tick, &memory.resume_until}) {
      archive.value(*number);
    }
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
