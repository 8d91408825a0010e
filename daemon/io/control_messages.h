// The lines of the control socket as values; the words are those of control/protocol.h.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "daemon/control/arming.h"
#include "estimator/fdi/alarm.h"

namespace monitor::io {

struct ControlRequest {
  enum class Kind : std::uint8_t {
    status,
    event,
    sine,
    hold,
    alarms,
    acknowledge,
    shelve,
    unshelve,
    reload,
    note,
    bad
  };
  Kind kind = Kind::bad;
  control::Event event = control::Event::disarm;  ///< of kind event
  double centre_m = 0.0;                          ///< of kind sine
  double amplitude_m = 0.0;
  double frequency_Hz = 0.0;
  std::string alarm;    ///< of kinds acknowledge (empty: all), shelve, unshelve
  double time_s = 0.0;  ///< of kind shelve
  std::string wrong;    ///< of kind bad: why, in one line
};

/// Never throws: what is no request is of kind bad.
[[nodiscard]] ControlRequest parse_request(const std::string& line);

/// Smallest changes that the fault detection could see in the present motion.
struct Detectable {
  struct Change {
    std::string name;  ///< with its unit, as "supply_pressure_Pa"
    double smallest;   ///< SI; NaN: not known
  };
  std::string source;
  std::int64_t tick = 0;
  std::string why;  ///< it tells too little, and which motion would; empty: it tells all
  std::vector<Change> changes;
};

/// What is told of the daemon; NaN: not known.
struct ControlStatus {
  struct Guard {
    std::string id, kind, action;
    bool active = false;
    double value = std::numeric_limits<double>::quiet_NaN();
  };
  struct Input {
    std::string id;
    double value = std::numeric_limits<double>::quiet_NaN();
  };
  /// Of several rod sensors, the configured one first.
  struct Rod {
    std::string id;
    double y_m = std::numeric_limits<double>::quiet_NaN();
    std::string fault;   ///< why it is out; empty: it is in
    double for_s = 0.0;  ///< it has been out
  };
  std::string rig_id, config_hash;
  control::State state = control::State::disarmed;
  bool holding = false;
  bool ramping = false;
  std::string latched_by;  ///< id of the guard; empty unless LATCHED
  std::string obstacle;    ///< why it cannot be armed; empty when it can
  std::string config_file, recorder_folder;
  std::string rules_hash;  ///< of estimators and bands, the learned ones in them
  double sample_time_s = std::numeric_limits<double>::quiet_NaN();
  std::string reload_refused;  ///< why the newest configuration was not taken; empty: it was
  double y_m = std::numeric_limits<double>::quiet_NaN();
  double reference_m = std::numeric_limits<double>::quiet_NaN();
  double u_V = std::numeric_limits<double>::quiet_NaN();
  std::int64_t ticks = 0;
  std::int64_t overruns = 0;
  std::int64_t active_alarms = 0;
  std::vector<Guard> guards;
  std::vector<Input> spare_rods, inputs;
  std::vector<Rod> rods;  ///< empty: there is one alone
  std::string rod_in_charge;
  double rod_in_charge_for_s = 0.0;
  std::vector<Detectable> detectable;
};

[[nodiscard]] std::string print_status(const ControlStatus& status);
/// What is told of an alarm.
struct ControlAlarm {
  estimator::fdi::Alarm alarm;
  double shelved_for_s = 0.0;
};

[[nodiscard]] std::string print_alarms(control::State state,
                                       const std::vector<ControlAlarm>& alarms);
/// `done`: the alarms that an act has changed.
[[nodiscard]] std::string print_acted(control::State state, const std::vector<std::string>& done);
/// What a reload has changed.
struct ControlReload {
  std::string config_hash;
  std::vector<std::string> changed;  ///< keys
  std::vector<std::string> warm;     ///< estimators that went on
  std::vector<std::string> cold;     ///< estimators that began anew
  std::vector<std::string> ended;    ///< alarms that stood and are no more
};
[[nodiscard]] std::string print_reloaded(control::State state, const ControlReload& reload);
[[nodiscard]] std::string print_done(control::State state);
[[nodiscard]] std::string print_rejected(control::State state, const std::string& reason);

}  // namespace monitor::io
