// A book of alarms whose lives are told as they go on. One tick is one second.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "estimator/fdi/alarm_book.h"

namespace estimator::fdi {

/// A book, and what it tells of as "12 name STATE".
class AlarmLife : public testing::Test {
 protected:
  std::size_t declare(const char* name, const AlarmRules& rules = {}) {
    Alarm alarm;
    alarm.source = "s";
    alarm.name = name;
    alarm.rules = rules;
    return book.declare(alarm);
  }
  void pass(std::int64_t tick) {
    book.advance(tick, tick * 1'000'000, [this](const Alarm& alarm) { tell(&alarm); });
  }
  void cause(std::int64_t tick, std::size_t number, Severity severity = Severity::major) {
    pass(tick);
    AlarmInput input;
    input.severity = severity;
    input.tick = tick;
    input.reason = severity == Severity::ok ? "inside" : "outside";
    tell(book.set(number, input));
  }
  void gone(std::int64_t tick, std::size_t number) { cause(tick, number, Severity::ok); }
  void tell(const Alarm* alarm) {
    if (alarm == nullptr) return;
    told.push_back(std::to_string(alarm->tick) + " " + alarm->name + " " +
                   to_string(alarm->state()));
  }

  AlarmBook book{1.0};
  std::vector<std::string> told;
};

}  // namespace estimator::fdi
