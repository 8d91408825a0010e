// The register map of a servo with a position, a command and a time-out, and what must hold of it.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/hal/modbus/device.h"
#include "tests/hal/modbus/stand.h"

namespace hal::modbus {

inline constexpr int kCommand = 2;
inline constexpr int kWatchdog = 1;
inline constexpr int kPosition = 4;
inline constexpr double kNull_V = 0.25;
inline constexpr std::uint16_t kNullRaw = 250;

inline std::string map_of(const std::string& options = "", const std::string& registers = "") {
  return options +
         "timeout_s = 0.1\njitter_s = 10.0\nlongest_pause_s = 0.05\npriority = 0\n"
         "[modbus.registers.position]\nrole = \"rod\"\naddress = 4\nscale = 1e-3\nhigh = 2.0\n"
         "[modbus.registers.u]\nrole = \"valve_command\"\naddress = 2\ntype = \"int16\"\n"
         "scale = 1e-3\nlow = -10.0\nhigh = 10.0\n" +
         registers;
}
inline std::string tcp(const Device& device, const std::string& options = "",
                       const std::string& registers = "") {
  return map_of("address = \"127.0.0.1:" + std::to_string(device.port()) + "\"\n" + options,
                registers);
}

/// Every connection that was written on begins with null.
inline void expect_null_first(Device& device) {
  for (int c = 1; c <= device.connections(); ++c) {
    const auto writes = device.writes(c);
    if (writes.empty()) continue;
    EXPECT_EQ(writes[0].address, kCommand) << "connection " << c;
    EXPECT_EQ(writes[0].words[0], kNullRaw) << "connection " << c;
  }
}

}  // namespace hal::modbus
