#include "estimator/fdi/alarm.h"

namespace estimator::fdi {

void AlarmRules::visit(config::schema::Visitor& v) {
  constexpr double kDay_s = 86400.0;
  v.boolean({"acknowledge", "stays listed until somebody acknowledges it"}, acknowledge);
  v.boolean({"latch", "stays active until then"}, latch);
  v.integer({"count", "the alarm comes with so many times within count_window_s"}, count, {1, 100});
  v.number({"count_window_s", "or when it lasts that long"}, count_window_s, {0.0, kDay_s});
  v.integer({"chatter_count", "so many times within chatter_window_s are one long alarm; 0: never"},
            chatter_count, {0, 100});
  v.number({"chatter_window_s", "and how long it must be quiet then"}, chatter_window_s,
           {0.0, kDay_s});
  v.number({"shelve_limit_s", "longest time it can be shelved for; 0: it cannot"}, shelve_limit_s,
           {0.0, 7.0 * kDay_s});
}

const char* to_string(Severity severity) noexcept {
  constexpr const char* kTexts[] = {"OK", "MINOR", "MAJOR", "INVALID"};
  return kTexts[static_cast<std::size_t>(severity)];
}

const char* to_string(AlarmState state) noexcept {
  constexpr const char* kTexts[] = {"NORMAL",   "UNACKNOWLEDGED", "ACKNOWLEDGED",
                                    "RETURNED", "LATCHED",        "SHELVED"};
  return kTexts[static_cast<std::size_t>(state)];
}

AlarmState Alarm::state() const noexcept {
  if (shelved) return AlarmState::shelved;
  if (latched) return AlarmState::latched;
  if (active) return acknowledged ? AlarmState::acknowledged : AlarmState::unacknowledged;
  return acknowledged ? AlarmState::normal : AlarmState::returned;
}

}  // namespace estimator::fdi
