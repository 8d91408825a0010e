// The register of every alarm: bands on quantities, and named conditions reported from elsewhere
// (a full disk, an overrunning loop). It leads each alarm through its life (alarm.h): what comes
// and goes, what people acknowledge and shelve, which came first, and tells each change.
//
// It has no clock: time is the tick and the wall clock of the newest sample, given to advance().
// One thread owns a book. Alarms are declared once; after that no call allocates, except where a
// condition brings a longer reason than before or a name never seen, and the acts of people.
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

/// What a method says the fault is.
struct FaultName {
  std::string_view parameter;               ///< "" when several cannot be told apart
  std::span<const std::string_view> group;  ///< those several
  double confidence = kNaN;
};

/// What an alarm's cause changes to.
struct AlarmInput {
  Severity severity = Severity::ok;
  std::int8_t direction = 0;
  std::int64_t tick = 0;
  double value = kNaN;
  double std_error = kNaN;
  std::string_view reason{};
  const FaultName* fault = nullptr;  ///< of an alarm named at run time, while it is out
};

/// What became of an act of a person.
struct AlarmActionResult {
  const Alarm* changed = nullptr;  ///< to be published; null when refused
  std::string refusal{};           ///< why not, in one line
};

/// The part of an alarm's life that outlasts the process.
struct PersistedAlarm {
  std::string source, name, reason, acknowledged_by, shelved_by;
  Severity severity = Severity::ok;
  std::int8_t direction = 0;
  bool active = false, latched = false, acknowledged = true, first_up = false;
  double value = kNaN;
  double shelved_for_s = 0.0;  ///< still; 0: it is not shelved
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

  /// Tells an alarm's cause. Returns the alarm when a person or a program should learn of it (a
  /// transition to be published), null otherwise; value and std_error are kept up to date in either
  /// case. An active alarm that is named anew is such a transition.
  const Alarm* set(std::size_t number, const AlarmInput& state);

  /// The same for a condition by name ("recorder", "disk_full"), declared at its first use.
  const Alarm* set_condition(std::string_view source, std::string_view name, Severity severity,
                             bool active, std::string_view reason, std::int64_t tick);

  /// Time passes: `changed(const Alarm&)` for each that a shelf or a time limit lets go. Call it
  /// with every sample, before anything is set. A tick that goes back starts all delays again.
  template <class F>
  void advance(std::int64_t tick, std::int64_t utc_us, F&& changed) {
    pass_to(tick, utc_us);
    for (std::size_t i = 0; i < alarms_.size(); ++i) {
      if (!memories_[i].timed) continue;
      if (const Alarm* alarm = expire(i)) changed(*alarm);
    }
  }

  AlarmActionResult acknowledge(std::size_t number, std::string_view who);
  /// For so long from now on; shelving what is shelved sets another time.
  AlarmActionResult shelve(std::size_t number, double time_s, std::string_view who);
  AlarmActionResult unshelve(std::size_t number);

  /// Shows an alarm as it was told, whatever its cause and rules say: for the replay of a log.
  void show(std::size_t number, const Alarm& told);

  /// kNone when there is no such alarm. `id`: "SOURCE.NAME", or the name when it is unique.
  [[nodiscard]] std::size_t find(std::string_view id) const noexcept;
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  [[nodiscard]] const std::vector<Alarm>& alarms() const noexcept { return alarms_; }
  [[nodiscard]] const Alarm& alarm(std::size_t number) const { return alarms_[number]; }
  /// Active and not shelved.
  [[nodiscard]] std::size_t active_count() const noexcept { return active_count_; }
  /// Seconds left on the shelf.
  [[nodiscard]] double shelved_for_s(const Alarm& alarm) const noexcept;
  /// Grows with each change of any life.
  [[nodiscard]] std::uint64_t changes() const noexcept { return changes_; }
  /// Every alarm back to normal, without a transition.
  void reset() noexcept;

  /// Lives that are not normal, and their way back after a restart: what was active comes back as
  /// unacknowledged or acknowledged when its cause is found again, what nobody has acknowledged
  /// stays so, and a shelf lasts for what is left of it. Alarms that no longer exist are left out;
  /// conditions are declared. Call before the first sample.
  [[nodiscard]] std::vector<PersistedAlarm> lives() const;
  void restore(const std::vector<PersistedAlarm>& lives);

  /// Goes on with the lives of the book before it, for new rules on the same alarms: what was
  /// active, latched, acknowledged or shelved there is so here. Alarms that only one of them has
  /// are left as they are. Call before the first sample.
  void inherit(const AlarmBook& before);

  /// Declares what the book before it has and this has not, save alarms on quantities: conditions
  /// that have come up. Before inherit().
  void adopt_conditions(const AlarmBook& before);

  /// Saves or restores every bit (state_archive.h).
  void serialize(StateArchive& archive);

  /// Calls `f(const Alarm&)` for each alarm that is active and not shelved: what is sent again at
  /// 1 Hz.
  template <class F>
  void for_each_active(F&& f) const {
    for (const Alarm& alarm : alarms_) {
      if (alarm.annunciated()) f(alarm);
    }
  }

 private:
  /// Ticks of the last n times; says whether they lie within a window.
  struct Recent {
    std::vector<std::int64_t> ticks;
    std::size_t next = 0;
    std::size_t filled = 0;
    bool add(std::int64_t tick, std::int64_t window) noexcept;
  };
  /// What an alarm's life needs to know besides what it shows.
  struct Memory {
    Recent comings;                    ///< of the cause
    Recent arrivals;                   ///< of the alarm
    Severity severity = Severity::ok;  ///< of the cause now
    std::int8_t direction = 0;
    bool admitted = false;         ///< the cause has come often or lasted long enough
    bool timed = false;            ///< time alone may change it
    bool resumes_known = false;    ///< acknowledged before a restart
    std::int64_t turned_tick = 0;  ///< when the cause last came or went
    std::int64_t resume_until = 0;
    Severity seen = Severity::ok;  ///< the gravest that has been acknowledged
  };

  void pass_to(std::int64_t tick, std::int64_t utc_us) noexcept;
  const Alarm* expire(std::size_t number);
  /// Shows what the cause and the rules ask for; null when that is what it shows already.
  const Alarm* settle(std::size_t number, std::int64_t tick, std::string_view reason);
  void come(std::size_t number, std::int64_t tick);
  /// True when the alarm has another name than before.
  bool name(Alarm& alarm, const FaultName& fault);
  void recount() noexcept;
  [[nodiscard]] std::int64_t ticks(double time_s) const noexcept;

  double sample_time_s_;
  AlarmRules condition_rules_;
  std::vector<Alarm> alarms_;
  std::vector<Memory> memories_;  ///< one for each alarm
  std::size_t active_count_ = 0;
  std::size_t standing_ = 0;  ///< not normal and not shelved
  std::int64_t tick_ = 0;
  std::int64_t utc_us_ = 0;
  std::uint64_t changes_ = 0;
};

}  // namespace estimator::fdi
