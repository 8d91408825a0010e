// A daemon that is killed leaves a note; `--null` brings the valve to null with nothing else. One
// device, one daemon.
#include <gmock/gmock.h>

#include <cmath>
#include <csignal>

#include "tests/daemon/program/commission_bench.h"

namespace program {
namespace {

using testing::HasSubstr;

/// Voltages that still count as null: two steps of the converter.
constexpr double kNull_V = 0.01;
/// A command that is far from null.
constexpr double kFar_V = 3.0;

bool at_null(const Look& look) { return std::abs(look.valve_V) < kNull_V; }

class LeftAtNull : public testing::Test {
 protected:
  [[nodiscard]] std::string note() const { return bench_.path("driving.toml"); }
  [[nodiscard]] bool noted() const { return std::filesystem::exists(note()); }
  [[nodiscard]] std::vector<std::string> arguments() const {
    return {"--config",  bench_.file(),
            "--driving", note(),
            "--lcm-url", "",
            "--set",     "modbus.address=127.0.0.1:" + std::to_string(bench_.port()),
            "--set",     "control.socket=",
            "--set",     "reference.amplitude_m=0.05",
            "--set",     "reference.frequency_Hz=1.0"};
  }
  /// Until the valve is far from null, under a command that the device keeps for ever.
  void moves() {
    ASSERT_TRUE(watcher_.wait_for([](const Look& look) { return look.valve_V > kFar_V; }));
    EXPECT_EQ(hal::hil_rig::set_remotely("127.0.0.1:" + std::to_string(bench_.port()),
                                         "command_timeout_s=0"),
              "");
    ASSERT_TRUE(watcher_.wait_for([](const Look& look) { return look.valve_V < -kFar_V; }));
  }
  Result null_by_note() const { return run({"--null", "--driving", note()}); }

  Bench bench_;
  Watcher watcher_{bench_.port()};
};

TEST_F(LeftAtNull, ByAKilledDaemonOnlyTheNoteLeadsTheValveToNull) {
  Daemon daemon(arguments());
  moves();
  EXPECT_TRUE(noted());
  kill(daemon.pid(), SIGKILL);
  daemon.wait();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_FALSE(at_null(watcher_.looks().back())) << "the device has a time-out: nothing is shown";
  std::filesystem::remove(bench_.file());  // what it was configured with need not be there
  const Result result = null_by_note();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "spoolwatchd: null written to the valve (modbus)\n");
  EXPECT_TRUE(watcher_.wait_for(at_null));
  EXPECT_FALSE(noted());
}

TEST_F(LeftAtNull, NothingIsWrittenWhereADaemonHasEndedInOrder) {
  Daemon daemon(arguments());
  moves();
  kill(daemon.pid(), SIGTERM);
  EXPECT_EQ(daemon.wait().exit_code, 0);
  EXPECT_TRUE(watcher_.wait_for(at_null));
  EXPECT_FALSE(noted());
  const Result result = null_by_note();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "spoolwatchd: nothing is driven\n");
}

TEST_F(LeftAtNull, WithAConfigurationTheValveIsBroughtToNullWithoutANote) {
  {
    Daemon daemon(arguments());
    moves();
    kill(daemon.pid(), SIGKILL);
    daemon.wait();
  }
  const Result result = run({"--config", bench_.file(), "--set", arguments()[7], "--null"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(watcher_.wait_for(at_null));
}

TEST_F(LeftAtNull, ADeviceThatIsNotThereIsOneLineAndTheNoteStays) {
  std::vector<std::string> arguments = this->arguments();
  {
    Daemon daemon(arguments);
    moves();
    kill(daemon.pid(), SIGKILL);
    daemon.wait();
  }
  std::ifstream in(note());
  std::string text((std::istreambuf_iterator<char>(in)), {});
  const std::string port = ":" + std::to_string(bench_.port());
  text.replace(text.find(port), port.size(), ":9");
  std::ofstream(note()) << text;
  const Result result = null_by_note();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("cannot be connected"));
  EXPECT_TRUE(noted());
}

TEST_F(LeftAtNull, ASimulatedValveGoesWithItsProcess) {
  const Result result = run({"--config", shipped("demo.toml"), "--null"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "spoolwatchd: no valve can have been left away from null\n");
}

TEST_F(LeftAtNull, WithoutConfigurationAndNoteIsAUsageError) {
  EXPECT_EQ(run({"--null"}).exit_code, 2);
}

TEST_F(LeftAtNull, ASecondDaemonOnTheSameDeviceIsRefusedInOneLineThatNamesTheFirst) {
  Daemon daemon(arguments());
  ASSERT_TRUE(watcher_.wait_for([](const Look& look) { return look.valve_V > kFar_V; }));
  const Result second = run(arguments());
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_EQ(second.err, "spoolwatchd: " + bench_.file() +
                            ": [modbus] address \"127.0.0.1:" + std::to_string(bench_.port()) +
                            "\": process " + std::to_string(daemon.pid()) +
                            " (spoolwatchd) drives it; one device, one daemon\n");
  std::vector<std::string> looking = arguments();
  looking.emplace_back("--check");
  EXPECT_EQ(run(looking).exit_code, 0) << "looking is allowed";
  kill(daemon.pid(), SIGKILL);
  daemon.wait();
  Daemon third(arguments());
  EXPECT_TRUE(watcher_.wait_for([](const Look& look) { return look.valve_V < -kFar_V; }));
}

}  // namespace
}  // namespace program
