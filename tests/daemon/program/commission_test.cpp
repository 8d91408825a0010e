// Commissioning on the bench rig, a process of its own over Modbus, watched by a client that sees
// the rig's own registers; and from there to a rod that moves as ordered. Truth is what the rig is
// made of.
#include <gmock/gmock.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <memory>
#include <thread>

#include "tests/daemon/program/commission_bench.h"

namespace program {
namespace {

using testing::HasSubstr;

// The rig's model at a standing rod: both orifices see half the supply pressure, so that
// speed = Cd w Kv sqrt(Ps / rho) / A per volt = 0.6 * 2.07e-2 * 2.23939e-5 * sqrt(6.89e6 / 847) /
// 6.33e-4. Damping takes 0.1 % of it; what the converter rounds off is read back, and what the
// lightly damped oil column rings with leaves 2 %.
constexpr double kGain_mps_per_V = 0.03963;
constexpr double kGainTolerance = 0.04;
/// A speed that is wrong by 0.1 mm/s, over the gain.
constexpr double kNullTolerance_V = 0.004;
/// Valve 2 * 0.7 / 628 rad/s = 2.2 ms, oil column d V / (2 beta A^2) = 0.4 ms, bus 0.5 ms; the bus
/// and this machine's load make it some milliseconds more, never less.
constexpr double kLeastLatency_s = 0.002;
constexpr double kMostLatency_s = 0.012;
constexpr double kMaxTravel_m = 0.005;

TEST(Commission, FindsWhatTheBenchRigIsMadeOfWithinTheTravel) {
  const Bench bench;
  Watcher watcher(bench.port());
  const Result result = bench.commission();
  ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_NEAR(bench.found("gain_mps_per_V"), kGain_mps_per_V, kGainTolerance * kGain_mps_per_V);
  EXPECT_NEAR(bench.found("null_V"), 0.0, kNullTolerance_V);
  EXPECT_LT(bench.found("dead_zone_V"), 2.0 * kNullTolerance_V);
  EXPECT_GT(bench.found("latency_s"), kLeastLatency_s);
  EXPECT_LT(bench.found("latency_s"), kMostLatency_s);
  // 2 um of noise rounded to steps of 5 um: from the noise alone to noise and rounding together,
  // and three standard errors of 80 readings.
  EXPECT_GT(bench.found("noise_m"), 2e-6 * 0.75);
  EXPECT_LT(bench.found("noise_m"), std::hypot(2e-6, 5e-6 / std::sqrt(12.0)) * 1.25);
  EXPECT_LT(travel_m(watcher.looks()), kMaxTravel_m);
  EXPECT_EQ(watcher.looks().back().valve_V, 0.0);
}

TEST(Commission, LetsARealRigBeArmedAndItMovesTheRightWay) {
  const Bench bench;
  ASSERT_EQ(bench.commission().exit_code, 0);
  const std::string socket = " --socket " + bench.socket();
  const std::string calibration = "rig.calibration=" + bench.out();
  const auto start = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = bench.arguments({"--lcm-url", "", "--set", calibration});
    words.insert(words.end(), more.begin(), more.end());
    auto daemon = std::make_unique<Daemon>(words);
    for (int i = 0; i < 200 && spoolwatch("status" + socket).exit_code != 0; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return daemon;
  };
  const auto end = [](Daemon& daemon) {
    kill(daemon.pid(), SIGTERM);
    EXPECT_EQ(daemon.wait().exit_code, 0);
  };
  const struct {
    const char* setting;
    const char* reason;
  } contradictions[] = {{"valve.null_V=0.5", "null_V is 0.5; the rod stands still at"},
                        {"modbus.registers.command.scale=-1.0", "has changed since"}};
  for (const auto& [setting, reason] : contradictions) {
    const auto daemon = start({"--set", setting});
    const Result refused = spoolwatch("arm" + socket);
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_THAT(refused.out, HasSubstr(reason));
    end(*daemon);
  }
  const auto daemon =
      start({"--set", "reference.amplitude_m=0.0", "--set", "reference.centre_m=0.315"});
  Watcher watcher(bench.port());
  ASSERT_EQ(spoolwatch("arm" + socket).out, "ARMED\n");
  ASSERT_EQ(spoolwatch("start" + socket).out, "RUN\n");
  // From about 0.305 m: commissioning ended within 5 mm of it.
  EXPECT_TRUE(
      watcher.wait_for([](const Look& look) { return std::abs(look.rod_m - 0.315) < 0.0005; }));
  for (const Look& look : watcher.looks()) ASSERT_GT(look.rod_m, 0.305 - kMaxTravel_m);
  end(*daemon);
}

TEST(Commission, FindsNullAndDeadZoneOfAValveThatHasThem) {
  const Folder folder;
  const std::string model = (folder.path() / "model.toml").string();
  {
    std::ifstream in(shipped("models/thesis_calibrated.toml"));
    std::ofstream(model) << in.rdbuf() << "\n[effects.null_bias]\noffset_V = -0.06\n"
                         << "[effects.deadband]\nhalf_width_V = 0.1\n";
  }
  const Bench bench({}, model);
  Watcher watcher(bench.port());
  const Result result = bench.commission();
  ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  // u - 0.06 V within +-0.1 V opens nothing: from -0.04 to 0.16 V.
  EXPECT_NEAR(bench.found("null_V"), 0.06, kNullTolerance_V);
  EXPECT_NEAR(bench.found("dead_zone_V"), 0.2, 2.0 * kNullTolerance_V);
  EXPECT_NEAR(bench.found("gain_mps_per_V"), kGain_mps_per_V, kGainTolerance * kGain_mps_per_V);
  EXPECT_LT(travel_m(watcher.looks()), kMaxTravel_m);
}

TEST(Commission, IsRefusedWhileADaemonServesTheRig) {
  const Bench bench;
  Daemon daemon(bench.arguments({"--lcm-url", ""}));
  for (int i = 0; i < 200 && spoolwatch("status --socket " + bench.socket()).exit_code != 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  const Result result = bench.commission();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("another daemon serves it"));
  kill(daemon.pid(), SIGTERM);
  EXPECT_EQ(daemon.wait().exit_code, 0);
}

TEST(Commission, CatchesAReversedValveOrSensorBeforeItRunsAway) {
  const std::vector<std::vector<std::string>> wirings = {
      {"valve_sign=-1"}, {"encoder_sign=-1", "encoder_offset_m=0.61"}};
  for (const auto& wiring : wirings) {
    const Bench bench(wiring);
    Watcher watcher(bench.port());
    const Result result = bench.commission();
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.out, HasSubstr("valve or rod sensor is reversed"));
    EXPECT_FALSE(bench.written());
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_LT(travel_m(watcher.looks()), kMaxTravel_m);
    EXPECT_GT(travel_m(watcher.looks()), 1e-4) << "nothing was tried";
    EXPECT_EQ(watcher.looks().back().valve_V, 0.0);
  }
}

TEST(Commission, OfBothReversedIsCaughtByThePersonWhoWatches) {
  const Bench bench({"valve_sign=-1", "encoder_sign=-1", "encoder_offset_m=0.61"});
  std::string words = "commission -o " + bench.out() + " --config " + bench.file();
  for (const std::string& word : bench.settings()) words += " " + word;
  // Agreed; the rod retracted.
  const Result result = spoolwatch(words + " < " + [&] {
    std::ofstream(bench.path("answers")) << "y\nn\n";
    return bench.path("answers");
  }());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("both valve and rod sensor are reversed"));
  EXPECT_FALSE(bench.written());
}

TEST(Commission, WithoutAgreementNothingMoves) {
  const Bench bench;
  Watcher watcher(bench.port());
  std::string words = "commission -o " + bench.out() + " --config " + bench.file();
  for (const std::string& word : bench.settings()) words += " " + word;
  const Result result = spoolwatch(words + " < /dev/null");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("not agreed"));
  EXPECT_FALSE(bench.written());
  ASSERT_FALSE(watcher.looks().empty());
  for (const Look& look : watcher.looks()) ASSERT_EQ(look.valve_V, 0.0);
}

TEST(Commission, ASignalEndsItAtNullWithoutAFile) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Bench bench;
    Watcher watcher(bench.port());
    Daemon daemon(bench.arguments({"--commission", bench.out(), "--yes"}));
    ASSERT_TRUE(watcher.wait_for([](const Look& look) { return std::abs(look.valve_V) > 0.05; }));
    kill(daemon.pid(), signal);
    const Result result = daemon.wait();
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_THAT(result.out, HasSubstr("stopped at null, nothing written"));
    EXPECT_FALSE(bench.written());
    EXPECT_EQ(watcher.looks().back().valve_V, 0.0);
  }
}

TEST(Commission, IsGivenUpWhenTheRigNoLongerAnswers) {
  const Bench bench;
  Watcher watcher(bench.port());
  Daemon daemon(bench.arguments({"--commission", bench.out(), "--yes"}));
  ASSERT_TRUE(watcher.wait_for([](const Look& look) { return std::abs(look.valve_V) > 0.05; }));
  bench.mute();
  const Result result = daemon.wait();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, testing::AnyOf(HasSubstr("the position is missing or stale"),
                                         HasSubstr("cannot be read"),
                                         HasSubstr("the valve does not accept commands")));
  EXPECT_FALSE(bench.written());
  EXPECT_TRUE(watcher.wait_for([](const Look& look) { return look.valve_V == 0.0; }));
  EXPECT_LT(travel_m(watcher.looks()), kMaxTravel_m);
}

TEST(Commission, WhatCannotBeCommissionedIsSaidInOneLine) {
  const Folder folder;
  const std::string out = (folder.path() / "c.toml").string();
  const Result none = run({"--config", shipped("replay.toml"), "--commission", out});
  EXPECT_EQ(none.exit_code, 78);
  EXPECT_THAT(none.err, HasSubstr("[valve] backend: is \"none\""));
  const Result authority = run({"--config", shipped("spoolwatchd.toml"), "--commission", out,
                                "--authority", "50", "--yes", "--clock", "virtual"});
  EXPECT_EQ(authority.exit_code, 2);
  EXPECT_THAT(authority.err, HasSubstr("--authority: is 50; allowed: up to [valve] limit_V"));
  const Result nowhere = run({"--config", shipped("spoolwatchd.toml"), "--commission",
                              (folder.path() / "no/c.toml").string(), "--yes"});
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("is not a folder"));
  const Result alone = run({"--config", shipped("spoolwatchd.toml"), "--yes"});
  EXPECT_EQ(alone.exit_code, 2);
}

TEST(Commission, ScaleIsTheTrueStrokeOverTheReadOne) {
  const Folder folder;
  const std::string out = (folder.path() / "c.toml").string();
  // The model's stroke is 0.61 m, the one given 2 % more. Either end is read to 10 um.
  const Result result = run({"--config", shipped("spoolwatchd.toml"), "--commission", out, "--yes",
                             "--clock", "virtual", "--stroke-mm", "622.2"});
  ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  const std::string before = "scale:  1 m of reading is ";
  const std::size_t at = result.out.find(before);
  ASSERT_NE(at, std::string::npos) << result.out;
  EXPECT_NEAR(std::stod(result.out.substr(at + before.size())), 1.02, 2.0 * 10e-6 / 0.61);
  EXPECT_THAT(
      result.out,
      HasSubstr("arming will be rejected with this configuration: 1 m of reading is 1.02 m"));
}

}  // namespace
}  // namespace program
