#include "estimator/fdi/alarm.h"

namespace estimator::fdi {

void AlarmRules::visit(config::schema::Visitor& v) {
  constexpr double kDay_s = 86400.0;
  v.boolean({"acknowledge", "stays listed until acknowledged"}, acknowledge);
  v.boolean({"latch", "stays active until acknowledged"}, latch);
  v.integer({"count", "number of occurrences within count_window_s that raises the alarm"}, count,
            {1, 100});
  v.number({"count_window_s", "window of count; a cause that lasts this long raises the alarm too"},
           count_window_s, {0.0, kDay_s});
  v.integer({"chatter_count",
             "occurrences within chatter_window_s that are merged into one alarm; 0: never"},
            chatter_count, {0, 100});
  v.number(
      {"chatter_window_s", "window of chatter_count, and quiet time that ends the merged alarm"},
      chatter_window_s, {0.0, kDay_s});
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
