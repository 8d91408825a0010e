// The serial line: the backend on one end of a pseudo-terminal, a device on the other.
#include <gmock/gmock.h>

#include "tests/hal/modbus/device.h"
#include "tests/hal/modbus/stand.h"

namespace hal::modbus {
namespace {

using testing::HasSubstr;

constexpr double kNull_V = 0.25;
constexpr std::uint16_t kNullRaw = 250;

std::string rtu(const Device& device, const std::string& options = "") {
  return "serial = \"" + device.serial() + "\"\nbaud = 115200\nparity = \"none\"\n" + options +
         "timeout_s = 0.1\njitter_s = 10.0\nlongest_pause_s = 0.05\npriority = 0\n"
         "[modbus.registers.position]\nrole = \"rod\"\naddress = 4\nscale = 1e-3\n"
         "[modbus.registers.u]\nrole = \"valve_command\"\naddress = 2\ntype = \"int16\"\n"
         "scale = 1e-3\n";
}

TEST(ModbusRtu, ReadsAndWrites) {
  Device device(Device::Line::rtu);
  device.set(4, 305);
  {
    Stand stand(rtu(device), kNull_V);
    EXPECT_TRUE(eventually([&] { return stand.turn(-1.5).y_m == 0.305; }));
    EXPECT_TRUE(eventually([&] { return device.get(2) == static_cast<std::uint16_t>(-1500); }));
    EXPECT_EQ(device.writes()[0].words[0], kNullRaw);
  }
  EXPECT_EQ(device.get(2), kNullRaw);
}

TEST(ModbusRtu, Function23) {
  Device device(Device::Line::rtu);
  device.set(4, 305);
  Stand stand(rtu(device, "combined = true\n"), kNull_V);
  EXPECT_TRUE(eventually([&] { return stand.turn(1.0).y_m == 0.305; }));
  EXPECT_TRUE(eventually([&] { return device.get(2) == 1000; }));
  EXPECT_EQ(device.received().back().function, 23);
}

TEST(ModbusRtu, BeginsAgainWithNullAfterABadReply) {
  for (const Reply reply : {Reply::lost, Reply::wrong_check, Reply::truncated, Reply::garbled,
                            Reply::wrong_transaction, Reply::wrong_echo, Reply::late}) {
    Device device(Device::Line::rtu);
    Stand stand(rtu(device), kNull_V);
    ASSERT_TRUE(eventually([&] {
      stand.turn(3.0);
      return device.get(2) == 3000;
    }));
    const std::size_t before = device.writes().size();
    device.answer(reply, 1);
    ASSERT_TRUE(eventually([&] {
      stand.turn(3.0);
      const auto writes = device.writes();
      for (std::size_t i = before; i < writes.size(); ++i) {
        if (writes[i].words[0] == kNullRaw) return true;
      }
      return false;
    })) << "no null after "
        << static_cast<int>(reply);
    ASSERT_TRUE(stand.turn_until(config::signals::Quality::good, 3.0)) << static_cast<int>(reply);
  }
}

TEST(ModbusRtu, ADeviceThatUnderstandsNothingIsOneClearLine) {
  Device device(Device::Line::rtu);
  device.answer(Reply::wrong_check);  // as a line of another speed or parity looks
  EXPECT_THAT(refusal_of(rtu(device)),
              HasSubstr("at 115200 baud, parity none: does not answer a request (Invalid CRC)"));
  device.answer(Reply::lost);
  EXPECT_THAT(refusal_of(rtu(device)), HasSubstr("its address or line settings, its unit"));
}

TEST(ModbusRtu, ALineInUseIsOneClearLine) {
  Device device(Device::Line::rtu);
  const Stand stand(rtu(device), kNull_V);
  EXPECT_THAT(refusal_of(rtu(device)),
              HasSubstr("is in use by another program (Device or resource busy)"));
}

TEST(ModbusRtu, LetsNullPassWhenTheThreadStandsStill) {
  Device device(Device::Line::rtu);
  Stand stand(rtu(device), kNull_V);
  ASSERT_TRUE(eventually([&] {
    stand.turn(3.0);
    return device.get(2) == 3000;
  }));
  stand.devices().valve->end_at_null();
  EXPECT_TRUE(eventually([&] { return device.get(2) == kNullRaw; }));
}

}  // namespace
}  // namespace hal::modbus
