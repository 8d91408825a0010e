// The loop's calls take nothing from the heap, whether the device answers or not.
#include <gtest/gtest.h>

#include "tests/count_allocations.h"
#include "tests/hal/modbus/device.h"
#include "tests/hal/modbus/stand.h"

namespace hal::modbus {
namespace {

TEST(ModbusAllocations, NoneInAnyCallOfTheLoop) {
  Device device;
  const BackendDevices devices =
      open_text("address = \"127.0.0.1:" + std::to_string(device.port()) +
                "\"\ntimeout_s = 0.1\npriority = 0\n"
                "[modbus.registers.position]\nrole = \"rod\"\naddress = 4\n"
                "[modbus.registers.u]\nrole = \"valve_command\"\naddress = 2\n"
                "[modbus.registers.back]\nrole = \"valve_readback\"\naddress = 2\n"
                "[modbus.registers.p]\nrole = \"input\"\naddress = 5\n"
                "[modbus.registers.permit]\nrole = \"output\"\naddress = 6\n");
  RodSensor& rod = *devices.rods.at("position");
  Input& input = *devices.inputs.at("p");
  Output& output = *devices.outputs.at("permit");
  bool answered = false;
  bool failed = false;
  const long before = allocations;
  for (int i = 0; i < 60; ++i) {
    const Tick tick{i, i * 20'000'000LL};
    answered = rod.read(tick).quality == config::signals::Quality::good || answered;
    failed = rod.read(tick).quality == config::signals::Quality::bad || failed;
    input.read(tick);
    devices.valve->write(i, tick);
    devices.valve->go_null();
    output.set(i % 2 == 0);
    if (i == 20) device.answer(Reply::lost);
    timespec period{0, 20'000'000};
    nanosleep(&period, nullptr);
  }
  devices.valve->end_at_null();
  EXPECT_EQ(allocations - before, 0);
  EXPECT_TRUE(answered);
  EXPECT_TRUE(failed);
}

}  // namespace
}  // namespace hal::modbus
