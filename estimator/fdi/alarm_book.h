// The register of all alarms: bands on quantities, and named conditions reported from elsewhere (a
// full disk, an overrunning loop). Drives the state of each alarm (alarm.h): raised, returned,
// acknowledged, shelved, first-up; and reports each transition.
//
// The book has no clock: time is the tick and the wall clock of the newest sample, passed to
// advance(). One thread owns a book. Alarms are declared once; after that no call allocates, except
// for a condition with a longer reason or a new name, and for actions of people.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/fdi/alarm.h"
#include "estimator/state_archive.h"

namespace estimator::fdi {

/// The fault according to a method.
struct FaultName {
  std::string_view parameter;               ///< "" when several are indistinguishable
  std::span<const std::string_view> group;  ///< the indistinguishable ones
  double confidence = kNaN;
};

/// Present state of an alarm's cause.
struct AlarmInput {
  Severity severity = Severity::ok;
  std::int8_t direction = 0;
  std::int64_t tick = 0;
  double value = kNaN;
  double std_error = kNaN;
  std::string_view reason{};
  const FaultName* fault = nullptr;  ///< for an alarm named at run time, while severity is not ok
};

/// Result of an acknowledge, shelve or unshelve action.
struct AlarmActionResult {
  const Alarm* changed = nullptr;  ///< to be published; null when refused
  std::string refusal{};           ///< why not, in one line
};

/// The part of an alarm's state that survives a restart of the process.
struct PersistedAlarm {
  std::string source, name, reason, acknowledged_by, shelved_by;
  Severity severity = Severity::ok;
  std::int8_t direction = 0;
  bool active = false, latched = false, acknowledged = true, first_up = false;
  double value = kNaN;
  double shelved_for_s = 0.0;  ///< remaining; 0: not shelved
  std::int64_t came_utc_us = 0;
  std::int64_t times = 0;
};

class AlarmBook {
 public:
  explicit AlarmBook(double sample_time_s = 1.0) : sample_time_s_(sample_time_s) {}

  /// Adds an alarm, normal; its number stays valid for the book's life.
  std::size_t declare(Alarm alarm);
  /// Rules of conditions that are declared at their first use.
  void set_condition_rules(const AlarmRules& rules) { condition_rules_ = rules; }
  [[nodiscard]] const AlarmRules& condition_rules() const noexcept { return condition_rules_; }

  /// Updates an alarm's cause. Returns the alarm on a transition to be published, null otherwise;
  /// value and std_error are updated in either case. A new fault name of an active alarm is such a
  /// transition.
  const Alarm* set(std::size_t number, const AlarmInput& state);

  /// Likewise for a condition by name ("recorder", "disk_full"), declared at first use.
  const Alarm* set_condition(std::string_view source, std::string_view name, Severity severity,
                             bool active, std::string_view reason, std::int64_t tick);

  /// Advances time; calls `changed(const Alarm&)` for each alarm whose shelving or time limit
  /// expires. Call with every sample, before any set(). A decreasing tick restarts all delays.
  template <class F>
  void advance(std::int64_t tick, std::int64_t utc_us, F&& changed) {
    pass_to(tick, utc_us);
    for (std::size_t i = 0; i < alarms_.size(); ++i) {
      if (!memories_[i].timed) continue;
      if (const Alarm* alarm = expire(i)) changed(*alarm);
    }
  }

  AlarmActionResult acknowledge(std::size_t number, std::string_view who);
  /// For `time_s` from now on; shelving a shelved alarm sets a new time.
  AlarmActionResult shelve(std::size_t number, double time_s, std::string_view who);
  AlarmActionResult unshelve(std::size_t number);

  /// Forces a recorded state regardless of cause and rules (log replay only).
  void force_state(std::size_t number, const Alarm& recorded);

  /// kNone when there is no such alarm. `id`: "SOURCE.NAME", or the name when it is unique.
  [[nodiscard]] std::size_t find(std::string_view id) const noexcept;
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  [[nodiscard]] const std::vector<Alarm>& alarms() const noexcept { return alarms_; }
  [[nodiscard]] const Alarm& alarm(std::size_t number) const { return alarms_[number]; }
  /// Active and not shelved.
  [[nodiscard]] std::size_t active_count() const noexcept { return active_count_; }
  /// Remaining shelving time, s.
  [[nodiscard]] double shelved_for_s(const Alarm& alarm) const noexcept;
  /// Increases with each state change of any alarm.
  [[nodiscard]] std::uint64_t changes() const noexcept { return changes_; }
  /// Every alarm back to normal, without a transition.
  void reset() noexcept;

  /// Alarms that are not normal, and their restoration after a restart: an active alarm returns as
  /// unacknowledged or acknowledged when its cause is found again, an unacknowledged one stays so,
  /// and shelving continues for the remaining time. Alarms that no longer exist are dropped;
  /// conditions are declared. Call before the first sample.
  [[nodiscard]] std::vector<PersistedAlarm> persisted_alarms() const;
  void restore(const std::vector<PersistedAlarm>& alarms);

  /// Takes over the states of a book with other rules for the same alarms: active, latched,
  /// acknowledged, shelved. Alarms that only one of the books has are unaffected. Call before the
  /// first sample.
  void inherit(const AlarmBook& before);

  /// Declares the conditions that `before` has and this book lacks; alarms on quantities are not
  /// adopted. Call before inherit().
  void adopt_conditions(const AlarmBook& before);

  /// Saves or restores every bit (state_archive.h).
  void serialize(StateArchive& archive);

  /// Calls `f(const Alarm&)` for each alarm that is active and not shelved: those sent again at
  /// 1 Hz.
  template <class F>
  void for_each_active(F&& f) const {
    for (const Alarm& alarm : alarms_) {
      if (alarm.annunciated()) f(alarm);
    }
  }

 private:
  /// Ticks of the last n events; tests whether they lie within a window.
  struct Recent {
    std::vector<std::int64_t> ticks;
    std::size_t next = 0;
    std::size_t filled = 0;
    bool add(std::int64_t tick, std::int64_t window) noexcept;
  };
  /// State of an alarm's cause, and timers; not published.
  struct Memory {
    Recent comings;                    ///< occurrences of the cause
    Recent arrivals;                   ///< activations of the alarm
    Severity severity = Severity::ok;  ///< present severity of the cause
    std::int8_t direction = 0;
    bool admitted = false;         ///< the cause has occurred often or lasted long enough
    bool timed = false;            ///< time alone may change the state
    bool resumes_known = false;    ///< acknowledged before a restart
    std::int64_t turned_tick = 0;  ///< when the cause last appeared or disappeared
    std::int64_t resume_until = 0;
    Severity seen = Severity::ok;  ///< the highest severity acknowledged
  };

  void pass_to(std::int64_t tick, std::int64_t utc_us) noexcept;
  const Alarm* expire(std::size_t number);
  /// Applies cause and rules to the published state; null when nothing changes.
  const Alarm* settle(std::size_t number, std::int64_t tick, std::string_view reason);
  void come(std::size_t number, std::int64_t tick);
  /// True when the fault name has changed.
  bool name(Alarm& alarm, const FaultName& fault);
  void recount() noexcept;
  [[nodiscard]] std::int64_t ticks(double time_s) const noexcept;

  double sample_time_s_;
  AlarmRules condition_rules_;
  std::vector<Alarm> alarms_;
  std::vector<Memory> memories_;  ///< one for each alarm
  std::size_t active_count_ = 0;
  std::size_t standing_ = 0;  ///< alarms not normal and not shelved
  std::int64_t tick_ = 0;
  std::int64_t utc_us_ = 0;
  std::uint64_t changes_ = 0;
};

}  // namespace estimator::fdi
