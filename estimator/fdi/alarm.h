// An alarm and its state, in the terms of ISA-18.2 and EPICS.
//
//   NORMAL          not active, nothing to acknowledge
//   UNACKNOWLEDGED  active, not acknowledged
//   ACKNOWLEDGED    active, acknowledged
//   RETURNED        the quantity is normal again, the alarm is not acknowledged
//   LATCHED         likewise, for an alarm that stays active until acknowledged
//   SHELVED         set aside by a person for a time: listed, but not annunciated
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "config/signals/nan.h"

namespace estimator::fdi {

using config::signals::kNaN;

/// In rising order, as in alarm_t. invalid: the monitored quantity cannot be trusted.
enum class Severity : std::int8_t { ok = 0, minor = 1, major = 2, invalid = 3 };

[[nodiscard]] const char* to_string(Severity severity) noexcept;

/// Rules of an alarm's state transitions; keys of [[band]], and of [alarms] for all other alarms.
struct AlarmRules {
  bool acknowledge = true;  ///< stays listed until acknowledged
  bool latch = false;       ///< stays active until acknowledged
  /// Raised at the count-th occurrence within count_window_s, or when the quantity has been outside
  /// for count_window_s.
  std::int64_t count = 1;
  double count_window_s = 60.0;
  /// An alarm raised this often within chatter_window_s stays active until quiet for as long.
  std::int64_t chatter_count = 3;  ///< 0: no chatter suppression
  double chatter_window_s = 60.0;
  double shelve_limit_s = 28800.0;  ///< longest shelving time; 0: never

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
  std::string source;     ///< method: an estimator's id, "sample", "loop", "recorder", ...
  std::string name;       ///< unique within its source
  std::string quantity;   ///< the quantity monitored, e.g. period.b1
  std::string parameter;  ///< the physical parameter, "" when unknown
  std::vector<std::string> ambiguity_group;  ///< indistinguishable parameters
  std::string guidance;
  std::string reason;
  Severity severity = Severity::ok;
  bool active = false;                ///< severity is not ok
  bool first_up = false;              ///< raised while no other stood; until normal again
  std::int8_t direction = 0;          ///< -1 below, +1 above the band, 0 neither
  bool falls_with_parameter = false;  ///< the quantity falls when the parameter rises
  std::int64_t tick = 0;              ///< sample at which the state last changed
  double value = kNaN;
  double std_error = kNaN;
  double low = kNaN;
  double high = kNaN;
  /// Probability that the fault is the one named, 0 to 1; NaN where unknown.
  double confidence = kNaN;
  /// Parameter, ambiguity group and confidence are determined at run time, not configured.
  bool named_at_run_time = false;

  AlarmRules rules{};
  bool latched = false;            ///< active only because not acknowledged
  bool acknowledged = true;        ///< true as well when there is nothing to acknowledge
  bool shelved = false;            ///< until shelved_until
  bool chattering = false;         ///< held active until quiet
  std::int64_t shelved_until = 0;  ///< tick
  std::int64_t came_tick = 0;      ///< when it last became active
  std::int64_t came_utc_us = 0;
  std::int64_t times = 0;  ///< how often it has become active
  std::string acknowledged_by{};
  std::string shelved_by{};

  /// Active and not shelved.
  [[nodiscard]] bool annunciated() const noexcept { return active && !shelved; }
  /// Active or unacknowledged, shelved or not.
  [[nodiscard]] bool stands() const noexcept { return active || !acknowledged; }
  /// Set by a band on an estimated or measured quantity; not by a guard or the daemon itself.
  [[nodiscard]] bool on_quantity() const noexcept {
    return quantity.find('.') != std::string::npos;
  }
  [[nodiscard]] AlarmState state() const noexcept;
};

}  // namespace estimator::fdi
