// The backend against a device that behaves badly. Whatever goes wrong: the connection is closed,
// the reading turns bad, a new connection begins with null, and no command of before is ever sent
// again.
#include <gmock/gmock.h>

#include "tests/hal/modbus/servo.h"

namespace hal::modbus {
namespace {

using testing::HasSubstr;

TEST(ModbusPollThread, WritesNothingBeforeTheLoopDoes) {
  Device device;
  device.set(kPosition, 305);
  {
    Stand stand(tcp(device), kNull_V);
    for (int i = 0; i < 5; ++i) {
      const Reading reading = stand.read();
      EXPECT_NE(reading.quality, config::signals::Quality::bad);
      EXPECT_DOUBLE_EQ(reading.y_m, 0.305);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  EXPECT_TRUE(device.writes().empty()) << "also not when it ends";
}

TEST(ModbusPollThread, WritesNullThenTheTimeOutThenWhatTheLoopWants) {
  Device device;
  Stand stand(tcp(device, "watchdog_s = 0.05\n",
                  "[modbus.registers.w]\nrole = \"watchdog\"\naddress = 1\nscale = 1e-3\n"),
              kNull_V);
  stand.turn(1.5);
  ASSERT_TRUE(eventually([&] { return device.get(kCommand) == 1500; }));
  const auto writes = device.writes();
  ASSERT_GE(writes.size(), 3U);
  EXPECT_EQ(writes[0].words[0], kNullRaw);
  EXPECT_EQ(writes[1].address, kWatchdog);
  EXPECT_EQ(writes[1].words[0], 50);
  EXPECT_EQ(writes[2].words[0], 1500);
  EXPECT_DOUBLE_EQ(stand.applied().u_V, 1.5);
  EXPECT_TRUE(stand.applied().good);
}

TEST(ModbusPollThread, ReadsWhatTheDeviceHasNow) {
  Device device;
  Stand stand(tcp(device), kNull_V);
  for (const int raw : {10, 500, 1999}) {
    device.set(kPosition, static_cast<std::uint16_t>(raw));
    EXPECT_TRUE(eventually([&] { return stand.turn(0.0).y_m == raw * 1e-3; }));
  }
  device.set(kPosition, 2500);
  EXPECT_TRUE(stand.turn_until(config::signals::Quality::bad, 0.0)) << "beyond its limits";
}

TEST(ModbusPollThread, Function23WritesAndReadsInOneTransaction) {
  Device device;
  device.set(kPosition, 700);
  {
    Stand stand(tcp(device, "combined = true\n"), kNull_V);
    EXPECT_TRUE(eventually([&] { return std::abs(stand.turn(2.0).y_m - 0.7) < 1e-9; }));
    device.set(kPosition, 800);
    EXPECT_TRUE(eventually([&] { return std::abs(stand.turn(2.0).y_m - 0.8) < 1e-9; }));
    EXPECT_EQ(device.get(kCommand), 2000);
    const auto all = device.received();
    EXPECT_EQ(all.back().function, 23);
  }
  EXPECT_EQ(device.get(kCommand), kNullRaw) << "null is what it ends with";
}

TEST(ModbusPollThread, AnExceptionKeepsTheConnection) {
  Device device;
  Stand stand(tcp(device, "stale_after_s = 0.1\nbad_after_s = 0.4\n"), kNull_V);
  ASSERT_TRUE(stand.turn_until(config::signals::Quality::good, 3.0));
  const int before = device.connections();
  device.only_function(3);
  device.answer(Reply::busy);
  EXPECT_TRUE(stand.turn_until(config::signals::Quality::bad, 3.0));
  EXPECT_EQ(device.connections(), before);
  EXPECT_TRUE(stand.applied().good) << "commands are taken";
  device.answer(Reply::normal);
  EXPECT_TRUE(stand.turn_until(config::signals::Quality::good, 3.0));
  EXPECT_EQ(device.connections(), before);
}

TEST(ModbusPollThread, AWriteThatIsRefusedAgainAndAgainHasFailed) {
  Device device;
  Stand stand(tcp(device), kNull_V);
  ASSERT_TRUE(stand.turn_until(config::signals::Quality::good, 3.0));
  device.only_function(6);
  device.answer(Reply::busy);
  EXPECT_TRUE(eventually([&] {
    stand.turn(3.0);
    return !stand.applied().good;
  }));
}

TEST(ModbusPollThread, WritesNullWhenTheLoopFallsSilent) {
  Device device;
  Stand stand(tcp(device), kNull_V);
  ASSERT_TRUE(eventually([&] {
    stand.turn(3.0);
    return device.get(kCommand) == 3000;
  }));
  EXPECT_TRUE(eventually([&] { return device.get(kCommand) == kNullRaw; }));
  EXPECT_THAT(stand.devices().summary(), HasSubstr("1 silences"));
}

// Two periods are 40 ms; the device takes 85 ms for the command before.
TEST(ModbusPollThread, ReplacesACommandThatHasWaitedTooLongByNull) {
  Device device;
  Stand stand(tcp(device), kNull_V);
  ASSERT_TRUE(eventually([&] {
    stand.turn(3.0);
    return device.get(kCommand) == 3000;
  }));
  device.only_function(6);
  device.answer(Reply::slow, 1);
  const std::size_t before = device.writes().size();
  stand.devices().valve->write(3.0, {});
  ASSERT_TRUE(eventually([&] { return device.writes().size() > before; })) << "it is on its way";
  stand.devices().valve->write(5.0, {});
  EXPECT_TRUE(eventually([&] { return device.get(kCommand) == kNullRaw; }));
  for (const Received& write : device.writes()) EXPECT_NE(write.words[0], 5000);
}

TEST(ModbusPollThread, EndsAtNullAndStaysThere) {
  Device device;
  Stand stand(tcp(device), kNull_V);
  ASSERT_TRUE(eventually([&] {
    stand.turn(3.0);
    return device.get(kCommand) == 3000;
  }));
  EXPECT_TRUE(stand.devices().valve->end_at_null().good);
  EXPECT_EQ(device.get(kCommand), kNullRaw) << "it was waited for";
  for (int i = 0; i < 5; ++i) stand.turn(4.0);
  EXPECT_EQ(device.get(kCommand), kNullRaw);
}

// A process that dies in the thread that would have written null has to do without it.
TEST(ModbusPort, SendsARequestPastTheProtocol) {
  for (const Device::Line line : {Device::Line::tcp, Device::Line::rtu}) {
    Device device(line);
    Counters counters;
    ConnectionConfig config;
    if (line == Device::Line::tcp) config.host = "127.0.0.1";
    config.port = device.port();
    config.serial = device.serial();
    Connection port(config, counters);
    for (const char* type : {"int16", "float32"}) {
      Register r;
      r.type = type;
      const WriteChannel channel{"u", RegisterTable::holding, 7, Codec(r)};
      const auto frame = port.frame(channel, Codec(r).encode(1.0));
      EXPECT_FALSE(port.send_now(frame)) << "nobody is connected";
      ASSERT_TRUE(port.connect());
      EXPECT_TRUE(port.send_now(frame));
      EXPECT_TRUE(eventually([&] { return device.get(7) == (r.words() == 1 ? 1 : 0x3F80); }));
      port.close();
    }
  }
}

TEST(ModbusPollThread, AnAbsentDeviceOrRegisterIsOneClearLine) {
  std::string text;
  {
    Device device;
    text = tcp(device);
    EXPECT_EQ(refusal_of(text), "accepted");
    EXPECT_THAT(refusal_of(tcp(device, "", "[modbus.registers.p]\nrole=\"input\"\naddress=5000\n")),
                HasSubstr("[modbus.registers.p] address: is 5000, which the device refuses "
                          "(Illegal data address)"));
    EXPECT_THAT(refusal_of(tcp(device, "",
                               "[modbus.registers.p]\nrole=\"input\"\naddress=199\n"
                               "type=\"int32\"\n")),
                HasSubstr("[modbus.registers.p] address: is 199"));
    EXPECT_THAT(refusal_of(tcp(device, "",
                               "[modbus.registers.p]\nrole=\"input\"\naddress=1\n"
                               "function=\"discrete\"\n")),
                HasSubstr("Illegal function"));
    device.answer(Reply::lost);
    EXPECT_THAT(refusal_of(text), HasSubstr("does not answer a request (Connection timed out)"));
  }
  EXPECT_THAT(refusal_of(text, 0.0, 1), HasSubstr("cannot be connected (Connection refused)"));
}

}  // namespace
}  // namespace hal::modbus
