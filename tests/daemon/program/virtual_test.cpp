// The whole daemon in virtual time: the same bytes for the same seed, the source's alarm times,
// null as the last command, recorded data of any period.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>

#include "tests/daemon/program/log.h"
#include "tests/daemon/program/subprocess.h"

namespace program {
namespace {

constexpr double kTs_s = 0.005;

TEST(VirtualDaemon, SameSeedGivesTheSameBytesAndAnotherSeedDoesNot) {
  const Folder folder;
  const auto log = [&](const char* name, const char* seed) {
    const auto path = folder.path() / name;
    const Result result =
        run(virtual_run(shipped("demo.toml"), path,
                        {"--duration", "12", "--set", std::string("sim.seed=") + seed}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return bytes(path);
  };
  const std::string one = log("a", "3");
  EXPECT_GT(one.size(), 100'000U);
  EXPECT_EQ(one == log("b", "3"), true) << "the same seed gives other bytes";
  EXPECT_EQ(one == log("c", "4"), false) << "the seed does nothing";
}

TEST(VirtualDaemon, CaseIAlarmsComeAndGoAtTheSourcesTimes) {
  const Folder folder;
  ASSERT_EQ(
      run(virtual_run(shipped("thesis_case1.toml"), folder.path() / "log", {"--duration", "60"}))
          .exit_code,
      0);
  const Log log = read_log(folder.path() / "log");
  EXPECT_EQ(log.timeline("supply_pressure", kTs_s), "18.0 high, 32.0 off, 48.0 low");
}

TEST(VirtualDaemon, SlidingWindowAlarmsWithinSixTenthsOfASecondOnARealisticRig) {
  // Fault times spread over a period of the motion; encoder, converter and noise as in demo.toml.
  for (const double at_s : {4.0, 4.4, 4.8, 5.2, 5.6}) {
    const Folder folder;
    ASSERT_EQ(
        run(virtual_run(shipped("demo.toml"), folder.path() / "log",
                        {"--duration", "8", "--set", "sim.fault.0.at_s=" + std::to_string(at_s)}))
            .exit_code,
        0);
    double first_s = INFINITY;
    for (const auto& alarm : read_log(folder.path() / "log").alarms) {
      if (alarm.name != "supply_pressure_fast") continue;
      first_s = std::min(first_s, static_cast<double>(alarm.tick) * kTs_s);
    }
    EXPECT_GE(first_s, at_s) << "a false alarm";
    EXPECT_LE(first_s, at_s + 0.6);
  }
}

TEST(VirtualDaemon, CaseIIAlarmsComeAndGoAtTheSourcesTimes) {
  const Folder folder;
  ASSERT_EQ(
      run(virtual_run(shipped("thesis_case2.toml"), folder.path() / "log", {"--duration", "60"}))
          .exit_code,
      0);
  const Log log = read_log(folder.path() / "log");
  EXPECT_EQ(log.timeline("damping", kTs_s), "18.0 low, 32.0 off, 48.0 high");
}

TEST(VirtualDaemon, SaysThatTheLogLacksMessagesAndFails) {
  const Folder folder;
  const Result result =
      run(virtual_run(shipped("demo.toml"), folder.path() / "log", {"--duration", "10"}),
          {.file_bytes = 50'000});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, testing::ContainsRegex(
                              "recorder: [0-9]+ messages are not in the log \\(File too large\\)"));
}

TEST(VirtualDaemon, WritesNoLineOfTextIntoItsLogWhereStderrIsClosed) {
  const Folder folder;
  EXPECT_EQ(run(virtual_run(shipped("demo.toml"), folder.path() / "log", {"--duration", "1"}),
                {.without_stderr = true})
                .exit_code,
            0);
  EXPECT_EQ(bytes(folder.path() / "log").find("privileges:"), std::string::npos);
}

TEST(VirtualDaemon, FollowsTheReferenceInRunAndEndsAtNull) {
  const Folder folder;
  ASSERT_EQ(run(virtual_run(shipped("thesis_case1.toml"), folder.path() / "log",
                            {"--duration", "4", "--set", "valve.null_V=0.25"}))
                .exit_code,
            0);
  const Log log = read_log(folder.path() / "log");
  ASSERT_EQ(log.samples.size(), 801U);
  for (std::size_t k = 0; k < 800; ++k) {
    const spoolwatch::sample_t& s = log.samples[k];
    ASSERT_EQ(s.tick, static_cast<std::int64_t>(k));
    ASSERT_EQ(s.seq, static_cast<std::int64_t>(k));
    ASSERT_EQ(s.utc_us, static_cast<std::int64_t>(k) * 5000) << "virtual time counts from 0";
    ASSERT_EQ(s.state, 3);
    ASSERT_NEAR(s.reference_m, 0.305 + 0.0254 * std::sin(M_PI * 0.005 * static_cast<double>(k)),
                1e-12);
    ASSERT_NEAR(s.u_requested_V, 0.25 + 250.0 * (s.reference_m - s.y_m), 1e-9);
  }
  EXPECT_EQ(log.samples.back().state, 1) << "the last sample must be DISARMED";
  EXPECT_DOUBLE_EQ(log.samples.back().u_applied_V, 0.25) << "the last write must be null";
}

TEST(VirtualDaemon, SendsHealthOnceASecondAndActiveAlarmsAgain) {
  const Folder folder;
  ASSERT_EQ(
      run(virtual_run(shipped("thesis_case1.toml"), folder.path() / "log", {"--duration", "25"}))
          .exit_code,
      0);
  const Log log = read_log(folder.path() / "log");
  EXPECT_EQ(log.healths.size(), 25U);
  EXPECT_EQ(log.healths.back().ticks, 5001);
  EXPECT_EQ(log.healths.back().privileges, "virtual time");
  EXPECT_EQ(log.healths.back().device, (std::vector<std::string>{"rod.sim", "valve.sim"}));
  int repeats = 0;
  for (const auto& alarm : log.alarms) {
    if (alarm.name == "supply_pressure" && alarm.repeat) ++repeats;
  }
  EXPECT_EQ(repeats, 8) << "one at each of 18 s to 25 s";
}

TEST(VirtualDaemon, WithoutAutoArmStaysDisarmedAtNull) {
  const Folder folder;
  ASSERT_EQ(
      run(virtual_run(shipped("spoolwatchd.toml"), folder.path() / "log",
                      {"--duration", "2", "--set", "valve.null_V=0.5", "--set", "sim.dac_bits=0"}))
          .exit_code,
      0);
  for (const auto& s : read_log(folder.path() / "log").samples) {
    ASSERT_EQ(s.state, 1);
    ASSERT_DOUBLE_EQ(s.u_applied_V, 0.5);
    ASSERT_TRUE(std::isnan(s.u_requested_V));
  }
}

TEST(VirtualDaemon, ReplaysARecordOfAnotherPeriodAndOtherUnits) {
  const Folder folder;
  const std::string record = (folder.path() / "record.csv").string();
  std::ofstream out(record);
  out << "t_s,u_V,y_mm,force_N\n" << std::setprecision(12);
  double y_mm = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double u_V = std::sin(0.02 * i);
    out << i * 0.0077531 << ',' << u_V << ',' << y_mm << ",1\n";
    y_mm += 0.05 * u_V;
  }
  out.close();
  const Result result = run(virtual_run(shipped("replay.toml"), folder.path() / "log",
                                        {"--set", "replay.record=" + record}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Log log = read_log(folder.path() / "log");
  ASSERT_EQ(log.samples.size(), 4000U);
  for (const auto& s : log.samples) {
    ASSERT_EQ(s.state, 0) << "a replay is MONITOR";
    ASSERT_EQ(s.t_write_ns, 0);
    ASSERT_NEAR(s.sample_time_s, 0.0077531, 1e-9);
  }
  EXPECT_NEAR(log.samples[100].u_applied_V, std::sin(2.0), 1e-9);
  ASSERT_FALSE(log.estimates.empty());
  const auto& last = log.estimates.back();  // y[k+1] = y[k] + 5e-5 u[k]: exactly ARX(1,1,1)
  ASSERT_EQ(last.source, "sliding");
  ASSERT_GE(last.size, 2);
  EXPECT_NEAR(last.value[0], -1.0, 1e-6);
  EXPECT_NEAR(last.value[1], 5e-5, 1e-9);
  EXPECT_TRUE(last.valid) << last.reason;
}

}  // namespace
}  // namespace program
