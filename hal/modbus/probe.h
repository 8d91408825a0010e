// Probes a device at start: it must answer and have every register of the map. Reads only.
#pragma once

#include <string>

#include "hal/modbus/command_slot.h"
#include "hal/modbus/connection.h"
#include "hal/modbus/register_map.h"

namespace hal::modbus {

struct ProbeOptions {
  std::string file;    ///< for messages
  std::string device;  ///< name in messages: address "127.0.0.1:502"
  double first_timeout_s = 0.2;
  double timeout_s = 0.004;  ///< set on the connection afterwards
};

/// Connects and reads each register once. Throws config::schema::DeviceUnavailable, or ConfigError
/// for a register that the device does not have.
[[nodiscard]] RegisterSnapshot probe(Connection& connection, const RegisterMap& map,
                                     const ProbeOptions& options);

}  // namespace hal::modbus
