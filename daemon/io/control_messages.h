// The lines of the control socket as values; the words are those of control/protocol.h.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "daemon/control/arming.h"

namespace monitor::io {

struct ControlRequest {
  enum class Kind : std::uint8_t { status, event, sine, hold, bad };
  Kind kind = Kind::bad;
  control::Event event = control::Event::disarm;  ///< of kind event
  double centre_m = 0.0;                          ///< of kind sine
  double amplitude_m = 0.0;
  double frequency_Hz = 0.0;
  std::string wrong;  ///< of kind bad: why, in one line
};

/// Never throws: what is no request is of kind bad.
[[nodiscard]] ControlRequest parse_request(const std::string& line);

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
  std::string rig_id, config_hash;
  control::State state = control::State::disarmed;
  bool holding = false;
  bool ramping = false;
  std::string latched_by;  ///< id of the guard; empty unless LATCHED
  std::string obstacle;    ///< why it cannot be armed; empty when it can
  double y_m = std::numeric_limits<double>::quiet_NaN();
  double reference_m = std::numeric_limits<double>::quiet_NaN();
  double u_V = std::numeric_limits<double>::quiet_NaN();
  std::int64_t ticks = 0;
  std::int64_t overruns = 0;
  std::vector<Guard> guards;
  std::vector<Input> spare_rods, inputs;
};

[[nodiscard]] std::string print_status(const ControlStatus& status);
[[nodiscard]] std::string print_done(control::State state);
[[nodiscard]] std::string print_refused(control::State state, const std::string& reason);

}  // namespace monitor::io
