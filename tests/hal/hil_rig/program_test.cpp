// spoolwatch-rig as its clients see it: requests byte by byte, as the protocol's text has them.
#include <gmock/gmock.h>
#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include "tests/hal/hil_rig/client.h"
#include "tests/hal/hil_rig/rig_process.h"

namespace hal::hil_rig {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> quiet(const std::vector<std::string>& more = {}) {
  std::vector<std::string> all = {"--config", shipped_config("bench_rig.toml"), "--set",
                                  "bus.priority=0"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

// 2.0 V is 40 00 00 00.
const Bytes kWrite2V{16, 0, 2, 0, 2, 4, 0x40, 0, 0, 0};

TEST(RigProgram, AnswersWithItsPositionInBothTables) {
  RigProcess rig(quiet());
  Client client(rig);
  for (const int function : {3, 4}) {
    const Bytes reply = client.ask({static_cast<std::uint8_t>(function), 0, 4, 0, 4});
    ASSERT_EQ(reply.size(), 10U);
    EXPECT_EQ(reply[0], function);
    EXPECT_NEAR(float_at(reply, 2), 0.305, 5e-5);
    const auto counts =
        static_cast<std::int32_t>(reply[6] << 24 | reply[7] << 16 | reply[8] << 8 | reply[9]);
    EXPECT_NEAR(counts * 5e-6, 0.305, 5e-5);
  }
  EXPECT_THAT(client.ask({2, 0, 0, 0, 2}), ElementsAre(2, 1, 3)) << "e-stop released, enabled";
}

TEST(RigProgram, TakesACommandInVoltsOrMillivoltsAndMovesTheRod) {
  RigProcess rig(quiet());
  Client client(rig);
  EXPECT_THAT(client.ask(kWrite2V), ElementsAre(16, 0, 2, 0, 2));
  EXPECT_NEAR(float_at(client.ask({3, 0, 8, 0, 2}), 2), 2.0, 0.005);
  double y_m = 0.0;
  for (int i = 0; i < 1000 && !(y_m > 0.32); ++i) {
    y_m = float_at(client.ask({3, 0, 4, 0, 2}), 2);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_GT(y_m, 0.32) << "positive extends";
  EXPECT_THAT(client.ask({6, 0, 0, 0xFC, 0x18}), ElementsAre(6, 0, 0, 0xFC, 0x18));  // -1000 mV
  EXPECT_NEAR(float_at(client.ask({3, 0, 8, 0, 2}), 2), -1.0, 0.005);
  // Function 23 writes 2 V and reads what the converter gave until then.
  const Bytes both = client.ask({23, 0, 8, 0, 2, 0, 2, 0, 2, 4, 0x40, 0, 0, 0});
  EXPECT_NEAR(float_at(both, 2), -1.0, 0.005);
  EXPECT_NEAR(float_at(client.ask({3, 0, 8, 0, 2}), 2), 2.0, 0.005);
}

TEST(RigProgram, TellsItsPressuresInKilopascals) {
  RigProcess rig(quiet());
  Client client(rig);
  const auto pressures = [&](int function) {
    const Bytes reply = client.ask({static_cast<std::uint8_t>(function), 0, 15, 0, 3});
    EXPECT_EQ(reply.size(), 8U);
    std::vector<int> all;
    for (std::size_t i = 2; i + 1 < reply.size(); i += 2) {
      all.push_back(static_cast<std::int16_t>(reply[i] << 8 | reply[i + 1]));
    }
    return all;
  };
  // At rest in the middle: 6.89 MPa, and half of it on either side.
  EXPECT_THAT(pressures(3), ElementsAre(6890, 3445, 3445));
  client.ask(kWrite2V);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const std::vector<int> moving = pressures(4);
  ASSERT_EQ(moving.size(), 3U);
  EXPECT_EQ(moving[0], 6890);
  // A (Pi - Po) = d v: with 6.33e-4 m2, 1000 N s/m and 0.09 m/s some 140 kPa.
  EXPECT_GT(moving[1] - moving[2], 50);
  EXPECT_LT(moving[1] - moving[2], 250);
}

TEST(RigProgram, RefusesWhatItDoesNotHaveOrDoesNotLetBeWritten) {
  RigProcess rig(quiet());
  Client client(rig);
  EXPECT_THAT(client.ask({3, 0x13, 0x88, 0, 1}), ElementsAre(0x83, 2));  // 5000
  EXPECT_THAT(client.ask({3, 0, 17, 0, 2}), ElementsAre(0x83, 2));
  EXPECT_THAT(client.ask({6, 0, 4, 0, 0}), ElementsAre(0x86, 2)) << "the position";
  EXPECT_THAT(client.ask({16, 0, 3, 0, 2, 4, 0, 0, 0, 0}), ElementsAre(0x90, 2));
  EXPECT_THAT(client.ask({6, 0x04, 0x4C, 0, 0}), ElementsAre(0x86, 2)) << "the reply, 1100";
  EXPECT_THAT(client.ask({23, 0, 4, 0, 2, 0, 6, 0, 1, 2, 0, 0}), ElementsAre(0x97, 2));
  EXPECT_THAT(client.ask({0x41, 0, 0, 0, 0}), testing::Not(testing::IsEmpty()));
}

TEST(RigProgram, AnswersOnASerialLineToo) {
  int outer = -1;
  int inner = -1;
  char name[128];
  ASSERT_EQ(openpty(&outer, &inner, name, nullptr, nullptr), 0);
  const RigProcess rig(quiet({"--serial", name}));
  ASSERT_FALSE(rig.address().empty());
  // Unit 1, function 3, two registers from 4, CRC: as the protocol's text computes it.
  const Bytes request{0x01, 0x03, 0x00, 0x04, 0x00, 0x02, 0x85, 0xCA};
  Bytes reply;
  pollfd file{outer, POLLIN, 0};
  // The line may be opened a moment after the port is.
  for (int i = 0; i < 20 && reply.empty(); ++i) {
    ASSERT_EQ(write(outer, request.data(), request.size()), 8);
    while (poll(&file, 1, reply.empty() ? 500 : 50) > 0) {
      std::uint8_t bytes[64];
      const ssize_t count = ::read(outer, bytes, sizeof bytes);
      reply.insert(reply.end(), bytes, bytes + std::max<ssize_t>(count, 0));
    }
  }
  ASSERT_EQ(reply.size(), 9U);
  EXPECT_EQ(reply[0], 1);
  EXPECT_EQ(reply[1], 3);
  EXPECT_NEAR(float_at(reply, 3), 0.305, 5e-5);
  close(outer);
  close(inner);
}

TEST(RigProgram, ItsTimeOutIsARegister) {
  RigProcess rig(quiet());
  Client client(rig);
  client.ask({6, 0, 1, 0, 50});
  client.ask(kWrite2V);
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  const Bytes reply = client.ask({3, 0, 8, 0, 3});
  EXPECT_EQ(float_at(reply, 2), 0.0);
  EXPECT_EQ(reply.at(7), 3) << "a command came, and timed out";
}

TEST(RigProgram, ServesSeveralClientsAndDropsTheOneThatStopsInAWord) {
  RigProcess rig(quiet());
  Client one(rig);
  Client two(rig);
  Client broken(rig);
  broken.send_bytes({0, 1, 0, 0, 0});
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(one.ask({3, 0, 4, 0, 2}).size(), 6U);
    EXPECT_EQ(two.ask({3, 0, 4, 0, 2}).size(), 6U);
  }
  EXPECT_TRUE(broken.closed());
}

TEST(RigProgram, TakesFaultsFromTheCommandLine) {
  RigProcess rig(quiet());
  Client client(rig);
  EXPECT_EQ(run_rig({"set", "--address", rig.address(), "e_stop=0", "enable=0"}).exit_code, 0);
  EXPECT_THAT(client.ask({2, 0, 0, 0, 2}), ElementsAre(2, 1, 0));
  client.ask(kWrite2V);
  EXPECT_EQ(float_at(client.ask({3, 0, 8, 0, 2}), 2), 0.0) << "the e-stop takes the valve";
  const Ended wrong = run_rig({"set", "--address", rig.address(), "e_stopp=1"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("e_stopp=1: names no parameter: e_stopp"));
  EXPECT_EQ(run_rig({"set", "--address", rig.address(), "mute_s=0.2"}).exit_code, 0);
  const std::string address = rig.address();
  rig.signal(SIGTERM);
  EXPECT_EQ(rig.wait(), 0);
  EXPECT_EQ(run_rig({"set", "--address", address, "e_stop=1"}).exit_code, 1) << "nobody there";
}

TEST(RigProgram, BadConfigurationIsOneLineAndExit78) {
  const auto expect_78 = [](const std::vector<std::string>& arguments, const std::string& text) {
    const Ended ended = run_rig(arguments);
    EXPECT_EQ(ended.exit_code, 78);
    EXPECT_THAT(ended.err, HasSubstr(text));
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  };
  const std::string config = shipped_config("bench_rig.toml");
  expect_78({"--config", "/no/such.toml"}, "/no/such.toml");
  expect_78({"--config", config, "--set", "sim.model=none.toml"}, "[sim] model");
  expect_78({"--config", config, "--set", "sim.fault.0.parameter=mas_kg"}, "[[sim.fault]]");
  expect_78({"--config", config, "--set", "field.valve_sgn=1"}, "valve_sgn");
  expect_78({"--config", config, "--listen", "rig:1502"}, "[bus] listen");
  expect_78({"--config", config, "--listen", "0", "--serial", "/dev/no-such"}, "[bus] serial");
  RigProcess rig(quiet());
  expect_78({"--config", config, "--listen", rig.address()}, "Address already in use");
  EXPECT_EQ(run_rig({}).exit_code, 2);
}

}  // namespace
}  // namespace hal::hil_rig
