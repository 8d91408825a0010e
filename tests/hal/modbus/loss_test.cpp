// The backend and a device that behaves badly. Whatever goes wrong: the connection is closed, the
// reading turns bad, a new connection begins with null, and no command of before is ever sent
// again.
#include <gmock/gmock.h>

#include "tests/hal/modbus/servo.h"

namespace hal::modbus {
namespace {

struct Misdeed {
  const char* name;
  Reply reply;
};

class ModbusMisdeed : public testing::TestWithParam<Misdeed> {};

TEST_P(ModbusMisdeed, ClosesTheConnectionAndBeginsAgainWithNull) {
  Device device;
  device.set(kPosition, 100);
  Stand stand(tcp(device), kNull_V);
  ASSERT_TRUE(
      eventually([&] { return stand.turn(3.0).quality == config::signals::Quality::good; }));
  const int before = device.connections();
  device.answer(GetParam().reply, 1);
  ASSERT_TRUE(eventually([&] {
    stand.turn(3.0);
    return device.connections() > before;
  })) << "the connection has not been closed";
  ASSERT_TRUE(eventually([&] {
    return stand.turn(3.0).quality == config::signals::Quality::good &&
           device.get(kCommand) == 3000;
  })) << "it does not come back";
  expect_null_first(device);
}

INSTANTIATE_TEST_SUITE_P(Each, ModbusMisdeed,
                         testing::Values(Misdeed{"Late", Reply::late}, Misdeed{"Lost", Reply::lost},
                                         Misdeed{"Doubled", Reply::doubled},
                                         Misdeed{"Truncated", Reply::truncated},
                                         Misdeed{"Garbled", Reply::garbled},
                                         Misdeed{"OfAnotherTransaction", Reply::wrong_transaction},
                                         Misdeed{"OfAnotherUnit", Reply::wrong_unit},
                                         Misdeed{"WithoutLength", Reply::no_length},
                                         Misdeed{"Closed", Reply::close}),
                         [](const auto& test) { return test.param.name; });

TEST(ModbusPollThread, TakesNoConfirmationOfAnotherAddress) {
  for (const bool multiple : {false, true}) {
    Device device;
    device.set(kPosition, 100);
    Stand stand(tcp(device, multiple ? "multiple_only = true\n" : ""), kNull_V);
    ASSERT_TRUE(stand.turn_until(config::signals::Quality::good, 3.0));
    const int before = device.connections();
    device.only_function(multiple ? 16 : 6);
    device.answer(Reply::wrong_echo, 1);
    ASSERT_TRUE(eventually([&] {
      stand.turn(3.0);
      return device.connections() > before;
    })) << "the connection has not been closed";
    expect_null_first(device);
  }
}

TEST(ModbusPollThread, AnExceptionOnAReadMakesItsReadingsMissingAtOnce) {
  for (const bool combined : {false, true}) {
    Device device;
    device.set(kPosition, 100);
    Stand stand(tcp(device, std::string("stale_after_s = 5.0\nbad_after_s = 10.0\n") +
                                (combined ? "combined = true\n" : "")),
                kNull_V);
    ASSERT_TRUE(stand.turn_until(config::signals::Quality::good, 3.0));
    device.only_function(combined ? 23 : 3);
    device.answer(Reply::busy);
    int turns = 0;
    while (turns < 20 && stand.turn(3.0).quality != config::signals::Quality::bad) ++turns;
    // One under way, one that brings the exception.
    EXPECT_LE(turns, 5) << "an old position counts as one";
    EXPECT_EQ(device.connections(), 1) << "the connection is intact";
    device.answer(Reply::normal);
    EXPECT_TRUE(stand.turn_until(config::signals::Quality::good, 3.0));
  }
}

TEST(ModbusPollThread, TurnsBadWithinATimeOutAndStaysSoWhileNothingAnswers) {
  Device device;
  Stand stand(tcp(device), kNull_V);
  ASSERT_TRUE(stand.turn_until(config::signals::Quality::good, 3.0));
  device.answer(Reply::lost);
  ASSERT_TRUE(stand.turn_until(config::signals::Quality::bad, 3.0));
  for (int i = 0; i < 20; ++i) {
    const Reading reading = stand.turn(3.0);
    EXPECT_EQ(reading.quality, config::signals::Quality::bad);
    EXPECT_TRUE(std::isnan(reading.y_m));
  }
  EXPECT_FALSE(stand.applied().good);
  EXPECT_TRUE(std::isnan(stand.applied().u_V));
  expect_null_first(device);
  device.answer(Reply::normal);
  EXPECT_TRUE(stand.turn_until(config::signals::Quality::good, 3.0));
}

// The commands wished while the cable was out must not fire when it is in again.
TEST(ModbusPollThread, NeverSendsWhatWasWishedWhileTheCableWasOut) {
  Device device;
  Stand stand(tcp(device), kNull_V);
  ASSERT_TRUE(eventually([&] {
    stand.turn(3.0);
    return device.get(kCommand) == 3000;
  }));
  device.unplug();
  for (int i = 0; i < 20; ++i) stand.turn(6.0);
  EXPECT_EQ(stand.turn(6.0).quality, config::signals::Quality::bad);
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

TEST(ModbusPollThread, ComesBackWithNullAfterTheDeviceHasRebooted) {
  Device device;
  Stand stand(tcp(device, "watchdog_s = 0.05\n",
                  "[modbus.registers.w]\nrole = \"watchdog\"\naddress = 1\nscale = 1e-3\n"),
              kNull_V);
  ASSERT_TRUE(stand.turn_until(config::signals::Quality::good, 3.0));
  device.reboot(200);
  ASSERT_TRUE(eventually([&] {
    stand.turn(4.0);
    return device.get(kCommand) == 4000;
  }));
  EXPECT_EQ(device.get(kWatchdog), 50) << "a device that has rebooted has forgotten its time-out";
  expect_null_first(device);
}

TEST(ModbusPollThread, GivesUpAConnectionThatIsOnlyHalfOpen) {
  Device device;
  Stand stand(tcp(device), kNull_V);
  ASSERT_TRUE(stand.turn_until(config::signals::Quality::good, 3.0));
  device.half_open(true);
  ASSERT_TRUE(stand.turn_until(config::signals::Quality::bad, 3.0));
  for (int i = 0; i < 10; ++i) EXPECT_EQ(stand.turn(3.0).quality, config::signals::Quality::bad);
  device.half_open(false);
  EXPECT_TRUE(stand.turn_until(config::signals::Quality::good, 3.0));
  expect_null_first(device);
}

}  // namespace
}  // namespace hal::modbus
