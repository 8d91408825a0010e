// The messages of the control socket as structs; the vocabulary is in control/protocol.h.
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
  control::Event event = control::Event::disarm;  ///< kind event
  double centre_m = 0.0;                          ///< kind sine
  double amplitude_m = 0.0;
  double frequency_Hz = 0.0;
  std::string alarm;    ///< kinds acknowledge (empty: all), shelve, unshelve
  double time_s = 0.0;  ///< kind shelve
  std::string wrong;    ///< kind bad: why, in one line
};

/// Never throws: malformed requests have kind bad.
[[nodiscard]] ControlRequest parse_request(const std::string& line);

/// The smallest changes that one source could detect in the present motion, and what disturbs it.
struct Detectable {
  struct Change {
    std::string name;  ///< with unit suffix, as "supply_pressure_Pa"
    double smallest;   ///< SI; NaN: unknown
  };
  std::string source;
  std::int64_t tick = 0;
  std::string why;  ///< why the motion is insufficient and which would suffice; empty: sufficient
  std::vector<Change> changes;
  /// Random force and spectral lines, SI; names with unit suffix, as "force_N". Unknown ones are
  /// left out.
  std::vector<std::pair<std::string, double>> disturbance;
};

/// The daemon's status; NaN: unknown.
struct ControlStatus {
  struct Guard {
    std::string id, kind, action;
    bool active = false;
    double value = std::numeric_limits<double>::quiet_NaN();
  };
  struct Input {
    std::string id;
    double value = std::numeric_limits<double>::quiet_NaN();
    std::string role{};  ///< as in the configuration; empty: a rod sensor
  };
  /// Redundant rod sensors, the configured one first.
  struct Rod {
    std::string id;
    double y_m = std::numeric_limits<double>::quiet_NaN();
    std::string fault;   ///< why the sensor is out; empty: in
    double for_s = 0.0;  ///< time out
  };
  std::string rig_id, config_hash;
  control::ArmingState state = control::ArmingState::disarmed;
  bool holding = false;
  bool ramping = false;
  std::string latched_by;       ///< id of the guard; empty unless LATCHED
  std::string latched_because;  ///< its reason in words
  std::string obstacle;         ///< why the rig cannot be armed; empty: it can
  std::string config_file, recorder_folder, alarm_folder;
  std::string rules_hash;  ///< hash of estimators and bands, learned bands included
  double sample_time_s = std::numeric_limits<double>::quiet_NaN();
  std::string reload_refused;  ///< why the newest reload was rejected; empty: it was not
  double y_m = std::numeric_limits<double>::quiet_NaN();
  double reference_m = std::numeric_limits<double>::quiet_NaN();
  double u_V = std::numeric_limits<double>::quiet_NaN();
  std::int64_t ticks = 0;
  std::int64_t overruns = 0;
  std::int64_t active_alarms = 0;
  std::vector<Guard> guards;
  std::vector<Input> spare_rods, inputs;
  std::vector<Rod> rods;  ///< empty: a single sensor
  std::string rod_in_charge;
  double rod_in_charge_for_s = 0.0;
  std::vector<Detectable> detectable;
};

[[nodiscard]] std::string print_status(const ControlStatus& status);
/// An alarm as listed to a client.
struct ControlAlarm {
  estimator::fdi::Alarm alarm;
  double shelved_for_s = 0.0;
};

[[nodiscard]] std::string print_alarms(control::ArmingState state,
                                       const std::vector<ControlAlarm>& alarms);
/// `done`: the alarms that a command has changed.
[[nodiscard]] std::string print_acted(control::ArmingState state,
                                      const std::vector<std::string>& done);
/// The effect of a reload.
struct ControlReload {
  std::string config_hash;
  std::vector<std::string> changed;  ///< keys
  std::vector<std::string> warm;     ///< estimators that continued
  std::vector<std::string> cold;     ///< estimators that restarted
  std::vector<std::string> ended;    ///< standing alarms that no longer exist
};
[[nodiscard]] std::string print_reloaded(control::ArmingState state, const ControlReload& reload);
[[nodiscard]] std::string print_done(control::ArmingState state);
[[nodiscard]] std::string print_rejected(control::ArmingState state, const std::string& reason);

}  // namespace monitor::io
