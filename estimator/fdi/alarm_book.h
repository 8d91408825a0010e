// The register of every alarm: bands on quantities, and named conditions reported from elsewhere
// (a full disk, an overrunning loop). It keeps each alarm's state and tells when it changes.
//
// One thread owns a book. Alarms are declared once; after that no call allocates, except where a
// condition brings a longer reason than before or a name never seen.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace estimator::fdi {

/// In rising order, as in alarm_t. invalid = what the alarm watches cannot be trusted.
enum class Severity : std::int8_t { ok = 0, minor = 1, major = 2, invalid = 3 };

[[nodiscard]] const char* to_string(Severity severity) noexcept;

/// An alarm and its state; the fields are those of alarm_t.
struct Alarm {
  std::string source;     ///< what watches: an estimator's id, "sample", "loop", "recorder", ...
  std::string name;       ///< unique within its source
  std::string quantity;   ///< the quantity watched, e.g. period.b1
  std::string parameter;  ///< the physical parameter meant, "" when not known
  std::vector<std::string> ambiguity_group;  ///< parameters that cannot be told apart
  std::string guidance;
  std::string reason;
  Severity severity = Severity::ok;
  bool active = false;                ///< severity is not ok
  bool first_up = false;              ///< was the first to become active when none was
  std::int8_t direction = 0;          ///< -1 below, +1 above the band, 0 neither
  bool falls_with_parameter = false;  ///< the quantity falls when the parameter rises
  std::int64_t tick = 0;              ///< sample at which the state last changed
  double value = std::numeric_limits<double>::quiet_NaN();
  double std_error = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
};

/// What an alarm changes to.
struct AlarmState {
  Severity severity = Severity::ok;
  std::int8_t direction = 0;
  std::int64_t tick = 0;
  double value = std::numeric_limits<double>::quiet_NaN();
  double std_error = std::numeric_limits<double>::quiet_NaN();
  std::string_view reason;
};

class AlarmBook {
 public:
  /// Adds an alarm, inactive; its number stays valid for the book's life.
  std::size_t declare(Alarm alarm);

  /// Sets an alarm's state. Returns the alarm when severity or direction changed (a transition to
  /// be published), null otherwise; value and std_error are kept up to date in either case.
  const Alarm* set(std::size_t number, const AlarmState& state);

  /// The same for a condition by name ("recorder", "disk_full"), declared at its first use.
  const Alarm* set_condition(std::string_view source, std::string_view name, Severity severity,
                             bool active, std::string_view reason, std::int64_t tick);

  [[nodiscard]] const std::vector<Alarm>& alarms() const noexcept { return alarms_; }
  [[nodiscard]] const Alarm& alarm(std::size_t number) const { return alarms_[number]; }
  [[nodiscard]] std::size_t active_count() const noexcept { return active_count_; }
  /// Every alarm back to ok, without a transition.
  void reset() noexcept;

  /// Calls `f(const Alarm&)` for each active alarm: what is sent again at 1 Hz.
  template <class F>
  void for_each_active(F&& f) const {
    for (const Alarm& alarm : alarms_) {
      if (alarm.active) f(alarm);
    }
  }

 private:
  std::vector<Alarm> alarms_;
  std::size_t active_count_ = 0;
};

}  // namespace estimator::fdi
