// The backend against a device that behaves badly. Whatever goes wrong: the connection is closed,
// the reading turns bad, a new connection begins with null, and no command of before is ever sent
// again.
#include <gmock/gmock.h>

#include <csignal>

#include "tests/hal/modbus/device.h"
#include "tests/hal/modbus/stand.h"

namespace hal::modbus {
namespace {

using testing::HasSubstr;

constexpr int kCommand = 2;
constexpr int kWatchdog = 1;
constexpr int kPosition = 4;
constexpr double kNull_V = 0.25;
constexpr std::uint16_t kNullRaw = 250;

std::string map_of(const std::string& options = "", const std::string& registers = "") {
  return options +
         "timeout_s = 0.1\njitter_s = 10.0\nlongest_pause_s = 0.05\npriority = 0\n"
         "[modbus.registers.position]\nrole = \"rod\"\naddress = 4\nscale = 1e-3\nhigh = 2.0\n"
         "[modbus.registers.u]\nrole = \"valve_command\"\naddress = 2\ntype = \"int16\"\n"
         "scale = 1e-3\nlow = -10.0\nhigh = 10.0\n" +
         registers;
}
std::string tcp(const Device& device, const std::string& options = "",
                const std::string& registers = "") {
  return map_of("address = \"127.0.0.1:" + std::to_string(device.port()) + "\"\n" + options,
                registers);
}

/// Every connection that was written on begins with null.
void expect_null_first(Device& device) {
  for (int c = 1; c <= device.connections(); ++c) {
    const auto writes = device.writes(c);
    if (writes.empty()) continue;
    EXPECT_EQ(writes[0].address, kCommand) << "connection " << c;
    EXPECT_EQ(writes[0].words[0], kNullRaw) << "connection " << c;
  }
}

TEST(ModbusLink, WritesNothingBeforeTheLoopDoes) {
  Device device;
  device.set(kPosition, 305);
  {
    Stand stand(tcp(device), kNull_V);
    for (int i = 0; i < 5; ++i) {
      const Reading reading = stand.read();
      EXPECT_NE(reading.quality, Quality::bad);
      EXPECT_DOUBLE_EQ(reading.y_m, 0.305);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  EXPECT_TRUE(device.writes().empty()) << "also not when it ends";
}

TEST(ModbusLink, WritesNullThenTheTimeOutThenWhatTheLoopWants) {
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

TEST(ModbusLink, ReadsWhatTheDeviceHasNow) {
  Device device;
  Stand stand(tcp(device), kNull_V);
  for (const int raw : {10, 500, 1999}) {
    device.set(kPosition, static_cast<std::uint16_t>(raw));
    EXPECT_TRUE(eventually([&] { return stand.turn(0.0).y_m == raw * 1e-3; }));
  }
  device.set(kPosition, 2500);
  EXPECT_TRUE(stand.turn_until(Quality::bad, 0.0)) << "beyond its limits";
}

TEST(ModbusLink, Function23WritesAndReadsInOneTransaction) {
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

struct Misdeed {
  const char* name;
  Reply reply;
};

class ModbusMisdeed : public testing::TestWithParam<Misdeed> {};

TEST_P(ModbusMisdeed, ClosesTheConnectionAndBeginsAgainWithNull) {
  Device device;
  device.set(kPosition, 100);
  Stand stand(tcp(device), kNull_V);
  ASSERT_TRUE(eventually([&] { return stand.turn(3.0).quality == Quality::good; }));
  const int before = device.connections();
  device.answer(GetParam().reply, 1);
  ASSERT_TRUE(eventually([&] {
    stand.turn(3.0);
    return device.connections() > before;
  })) << "the connection has not been closed";
  ASSERT_TRUE(eventually([&] {
    return stand.turn(3.0).quality == Quality::good && device.get(kCommand) == 3000;
  })) << "it does not come back";
  expect_null_first(device);
}

INSTANTIATE_TEST_SUITE_P(Each, ModbusMisdeed,
                         testing::Values(Misdeed{"Late", Reply::late}, Misdeed{"Lost", Reply::lost},
                                         Misdeed{"Doubled", Reply::doubled},
                                         Misdeed{"Truncated", Reply::truncated},
                                         Misdeed{"Garbled", Reply::garbled},
                                         Misdeed{"OfAnotherTransaction", Reply::wrong_transaction},
                                         Misdeed{"Closed", Reply::close}),
                         [](const auto& test) { return test.param.name; });

TEST(ModbusLink, TurnsBadWithinATimeOutAndStaysSoWhileNothingAnswers) {
  Device device;
  Stand stand(tcp(device), kNull_V);
  ASSERT_TRUE(stand.turn_until(Quality::good, 3.0));
  device.answer(Reply::lost);
  ASSERT_TRUE(stand.turn_until(Quality::bad, 3.0));
  for (int i = 0; i < 20; ++i) {
    const Reading reading = stand.turn(3.0);
    EXPECT_EQ(reading.quality, Quality::bad);
    EXPECT_TRUE(std::isnan(reading.y_m));
  }
  EXPECT_FALSE(stand.applied().good);
  EXPECT_TRUE(std::isnan(stand.applied().u_V));
  expect_null_first(device);
  device.answer(Reply::normal);
  EXPECT_TRUE(stand.turn_until(Quality::good, 3.0));
}

// The commands wished while the cable was out must not fire when it is in again.
TEST(ModbusLink, NeverSendsWhatWasWishedWhileTheCableWasOut) {
  Device device;
  Stand stand(tcp(device), kNull_V);
  ASSERT_TRUE(eventually([&] {
    stand.turn(3.0);
    return device.get(kCommand) == 3000;
  }));
  device.unplug();
  for (int i = 0; i < 20; ++i) stand.turn(6.0);
  EXPECT_EQ(stand.turn(6.0).quality, Quality::bad);
  const int before = device.connections();
  device.plug_in();
  ASSERT_TRUE(eventually([&] { return device.connections() > before; }));
  ASSERT_TRUE(eventually([&] {
    stand.turn(7.0);
    return device.get(kCommand) == 7000;
  }));
  for (const Received& write : device.writes()) EXPECT_NE(write.words[0], 6000);
  expect_null_first(device);
}

TEST(ModbusLink, ComesBackWithNullAfterTheDeviceHasRebooted) {
  Device device;
  Stand stand(tcp(device, "watchdog_s = 0.05\n",
                  "[modbus.registers.w]\nrole = \"watchdog\"\naddress = 1\nscale = 1e-3\n"),
              kNull_V);
  ASSERT_TRUE(stand.turn_until(Quality::good, 3.0));
  device.reboot(200);
  ASSERT_TRUE(eventually([&] {
    stand.turn(4.0);
    return device.get(kCommand) == 4000;
  }));
  EXPECT_EQ(device.get(kWatchdog), 50) << "a device that has rebooted has forgotten its time-out";
  expect_null_first(device);
}

TEST(ModbusLink, GivesUpAConnectionThatIsOnlyHalfOpen) {
  Device device;
  Stand stand(tcp(device), kNull_V);
  ASSERT_TRUE(stand.turn_until(Quality::good, 3.0));
  device.half_open(true);
  ASSERT_TRUE(stand.turn_until(Quality::bad, 3.0));
  for (int i = 0; i < 10; ++i) EXPECT_EQ(stand.turn(3.0).quality, Quality::bad);
  device.half_open(false);
  EXPECT_TRUE(stand.turn_until(Quality::good, 3.0));
  expect_null_first(device);
}

TEST(ModbusLink, AnExceptionKeepsTheConnectionAndAgesTheReading) {
  Device device;
  Stand stand(tcp(device, "stale_after_s = 0.1\nbad_after_s = 0.4\n"), kNull_V);
  ASSERT_TRUE(stand.turn_until(Quality::good, 3.0));
  const int before = device.connections();
  device.only_function(3);
  device.answer(Reply::busy);
  EXPECT_TRUE(stand.turn_until(Quality::stale, 3.0));
  EXPECT_TRUE(stand.turn_until(Quality::bad, 3.0));
  EXPECT_EQ(device.connections(), before);
  EXPECT_TRUE(stand.applied().good) << "commands are taken";
  device.answer(Reply::normal);
  EXPECT_TRUE(stand.turn_until(Quality::good, 3.0));
  EXPECT_EQ(device.connections(), before);
}

TEST(ModbusLink, AWriteThatIsRefusedAgainAndAgainHasFailed) {
  Device device;
  Stand stand(tcp(device), kNull_V);
  ASSERT_TRUE(stand.turn_until(Quality::good, 3.0));
  device.only_function(6);
  device.answer(Reply::busy);
  EXPECT_TRUE(eventually([&] {
    stand.turn(3.0);
    return !stand.applied().good;
  }));
}

TEST(ModbusLink, WritesNullWhenTheLoopFallsSilent) {
  Device device;
  Stand stand(tcp(device), kNull_V);
  ASSERT_TRUE(eventually([&] {
    stand.turn(3.0);
    return device.get(kCommand) == 3000;
  }));
  EXPECT_TRUE(eventually([&] { return device.get(kCommand) == kNullRaw; }));
  EXPECT_THAT(stand.offer().summary(), HasSubstr("1 silences"));
}

// Two periods are 40 ms; the device takes 85 ms for the command before.
TEST(ModbusLink, ReplacesACommandThatHasWaitedTooLongByNull) {
  Device device;
  Stand stand(tcp(device), kNull_V);
  ASSERT_TRUE(eventually([&] {
    stand.turn(3.0);
    return device.get(kCommand) == 3000;
  }));
  device.only_function(6);
  device.answer(Reply::slow, 1);
  stand.offer().valve->write(3.0, {});
  std::this_thread::sleep_for(std::chrono::milliseconds(2));  // the thread has taken it
  stand.offer().valve->write(5.0, {});
  EXPECT_TRUE(eventually([&] { return device.get(kCommand) == kNullRaw; }));
  for (const Received& write : device.writes()) EXPECT_NE(write.words[0], 5000);
}

TEST(ModbusLink, EndsAtNullAndStaysThere) {
  Device device;
  Stand stand(tcp(device), kNull_V);
  ASSERT_TRUE(eventually([&] {
    stand.turn(3.0);
    return device.get(kCommand) == 3000;
  }));
  EXPECT_TRUE(stand.offer().valve->end_at_null().good);
  EXPECT_EQ(device.get(kCommand), kNullRaw) << "it was waited for";
  for (int i = 0; i < 5; ++i) stand.turn(4.0);
  EXPECT_EQ(device.get(kCommand), kNullRaw);
}

// A process that dies in the thread that would have written null has to do without it.
TEST(ModbusPort, SendsARequestPastTheProtocol) {
  for (const Device::Line line : {Device::Line::tcp, Device::Line::rtu}) {
    Device device(line);
    Counters counters;
    PortConfig config;
    if (line == Device::Line::tcp) config.host = "127.0.0.1";
    config.port = device.port();
    config.serial = device.serial();
    Port port(config, counters);
    for (const char* type : {"int16", "float32"}) {
      Register r;
      r.type = type;
      const WriteChannel channel{"u", Table::holding, 7, Codec(r)};
      const auto frame = port.frame(channel, Codec(r).encode(1.0));
      EXPECT_FALSE(port.send_now(frame)) << "nobody is connected";
      ASSERT_TRUE(port.connect());
      EXPECT_TRUE(port.send_now(frame));
      EXPECT_TRUE(eventually([&] { return device.get(7) == (r.words() == 1 ? 1 : 0x3F80); }));
      port.close();
    }
  }
}

TEST(ModbusLink, AnAbsentDeviceOrRegisterIsOneClearLine) {
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
  EXPECT_THAT(refusal_of(text), HasSubstr("cannot be connected (Connection refused)"));
}

}  // namespace
}  // namespace hal::modbus
