// An alarm and its life, in the words of ISA-18.2 and EPICS.
//
//   NORMAL          nothing stands
//   UNACKNOWLEDGED  it is active, and nobody has said that he saw it
//   ACKNOWLEDGED    it is active, and somebody has
//   RETURNED        what it watches is normal again, but nobody has acknowledged it
//   LATCHED         the same of an alarm that stays active until it is acknowledged
//   SHELVED         put aside by a person for a time: listed, but not active for anyone
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "config/schema/visitor.h"
#include "config/signals/nan.h"

namespace estimator::fdi {

using config::signals::kNaN;

/// In rising order, as in alarm_t. invalid = what the alarm watches cannot be trusted.
enum class Severity : std::int8_t { ok = 0, minor = 1, major = 2, invalid = 3 };

[[nodiscard]] const char* to_string(Severity severity) noexcept;

/// How an alarm lives; keys of [[band]], and of [alarms] for all that is no band.
struct AlarmRules {
  bool acknowledge = true;  ///< stays listed until somebody has acknowledged it
  bool latch = false;       ///< stays active until then
  /// It comes with the count-th time within count_window_s, or when what it watches has been out
  /// for count_window_s.
  std::int64_t count = 1;
  double count_window_s = 60.0;
  /// One that comes so often within chatter_window_s stays active until it was quiet for as long.
  std::int64_t chatter_count = 3;  ///< 0: it may chatter
  double chatter_window_s = 60.0;
  double shelve_limit_s = 28800.0;  ///< longest time that it can be shelved for; 0: it cannot

  void visit(config::schema::Visitor& v);
};

enum class AlarmState : std::uint8_t {
  normal,
  unacknowledged,
  acknowledged,
  returned,
  latched,
  shelved
};

[[nodiscard]] const char* to_string(AlarmState state) noexcept;

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
  bool first_up = false;              ///< came first when none stood; until it is normal again
  std::int8_t direction = 0;          ///< -1 below, +1 above the band, 0 neither
  bool falls_with_parameter = false;  ///< the quantity falls when the parameter rises
  std::int64_t tick = 0;              ///< sample at which the state last changed
  double value = kNaN;
  double std_error = kNaN;
  double low = kNaN;
  double high = kNaN;
  /// That the fault is the one named, 0 to 1; NaN where nobody says.
  double confidence = kNaN;
  /// Parameter, ambiguity group and confidence are found while it runs, not configured.
  bool named_at_run_time = false;

  AlarmRules rules{};
  bool latched = false;            ///< active only because nobody has acknowledged it
  bool acknowledged = true;        ///< or there is nothing to acknowledge
  bool shelved = false;            ///< until shelved_until
  bool chattering = false;         ///< held active until it is quiet
  std::int64_t shelved_until = 0;  ///< tick
  std::int64_t came_tick = 0;      ///< when it last became active
  std::int64_t came_utc_us = 0;
  std::int64_t times = 0;  ///< how often it has become active
  std::string acknowledged_by{};
  std::string shelved_by{};

  /// What a person is told: active, and not shelved.
  [[nodiscard]] bool annunciated() const noexcept { return active && !shelved; }
  /// Not normal, shelved or not.
  [[nodiscard]] bool stands() const noexcept { return active || !acknowledged; }
  /// A band's, on what is estimated or measured; not a guard's or one of the daemon's own.
  [[nodiscard]] bool on_quantity() const noexcept {
    return quantity.find('.') != std::string::npos;
  }
  [[nodiscard]] AlarmState state() const noexcept;
};

}  // namespace estimator::fdi
