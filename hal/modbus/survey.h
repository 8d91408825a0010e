// The first look at a device: is it there, and does it have every register of the map? Reads only.
#pragma once

#include <string>

#include "hal/modbus/mailbox.h"
#include "hal/modbus/plan.h"
#include "hal/modbus/port.h"

namespace hal::modbus {

struct SurveyOptions {
  std::string file;    ///< for messages
  std::string device;  ///< how messages call the device: address "127.0.0.1:502"
  double first_timeout_s = 0.2;
  double timeout_s = 0.004;  ///< that the port is left with
};

/// Connects and reads each register once. Throws config::schema::ConfigError, one line.
[[nodiscard]] Snapshot survey(Port& port, const Plan& plan, const SurveyOptions& options);

}  // namespace hal::modbus
