// The whole daemon in virtual time: the same bytes for the same seed, the thesis's alarm times,
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

/// The shipped service, started by itself, with one thing that goes wrong.
Log run_with_trouble(const std::vector<std::string>& settings, const std::string& tables) {
  const Folder folder;
  std::ifstream shipped_file(shipped("spoolwatchd.toml"));
  const std::string text(std::istreambuf_iterator<char>(shipped_file), {});
  const std::string file = (folder.path() / "rig.toml").string();
  std::ofstream(file) << text << tables;
  std::vector<std::string> more = {
      "--duration",         "6",     "--set",
      "loop.auto_arm=true", "--set", "sim.model=" + shipped("models/thesis_calibrated.toml")};
  for (const std::string& setting : settings) {
    more.emplace_back("--set");
    more.push_back(setting);
  }
  const Result result = run(virtual_run(file, folder.path() / "log", more));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return read_log(folder.path() / "log");
}

TEST(VirtualDaemon, GuardsThatTripAreAlarmsWithReasonAndGuidance) {
  const Log log = run_with_trouble(
      {}, "[[sim.trouble]]\nkind = \"jump\"\nfrom_s = 3.0\nto_s = 4.0\nsize_m = 0.01\n");
  EXPECT_EQ(log.timeline("jump", kTs_s).substr(0, 8), "3.0 high") << log.timeline("jump", kTs_s);
  EXPECT_EQ(log.timeline("latched", kTs_s).substr(0, 4), "3.0 ");
  for (const auto& alarm : log.alarms) {
    if (alarm.name == "jump" && alarm.active == 1) {
      EXPECT_EQ(alarm.source, "loop");
      EXPECT_THAT(alarm.reason, testing::HasSubstr("the position jumped"));
      EXPECT_THAT(alarm.guidance, testing::HasSubstr("Check the rod sensor"));
      EXPECT_EQ(alarm.high, 0.005);
      EXPECT_NEAR(alarm.value, 0.01, 5e-4);
    }
    if (alarm.name == "latched" && alarm.active == 1) {
      EXPECT_EQ(alarm.reason, "guard jump: reset, then arm again");
    }
  }
  for (const auto& s : log.samples) ASSERT_EQ(s.state, s.tick < 600 ? 3 : 4) << s.tick;
}

TEST(VirtualDaemon, GuardsStaySilentOnAHealthyRig) {
  const Log log = run_with_trouble({}, "");
  for (const auto& alarm : log.alarms) EXPECT_NE(alarm.source, "loop") << alarm.name;
  EXPECT_EQ(log.samples[1000].state, 3);
}

TEST(VirtualDaemon, CountsSpareRodsAndInputsAsDevices) {
  const Log log =
      run_with_trouble({},
                       "[[spare_rod]]\nid = \"second\"\nbackend = \"sim\"\nchannel = \"second\"\n"
                       "[[sim.rod]]\nid = \"second\"\n");
  ASSERT_FALSE(log.healths.empty());
  const auto& health = log.healths.back();
  EXPECT_EQ(health.device,
            (std::vector<std::string>{"rod.sim", "valve.sim", "spare_rod.second", "input.e_stop"}));
  EXPECT_EQ(health.device_good, (std::vector<std::int64_t>{1201, 1201, 1201, 1201}));
  EXPECT_EQ(health.device_bad, (std::vector<std::int64_t>{0, 0, 0, 0}));
}

TEST(VirtualDaemon, OnlyWatchingTakesTheCommandFromAnInput) {
  const Folder folder;
  const std::string file = (folder.path() / "rig.toml").string();
  std::ofstream(file) << "schema_version = 1\n[rod]\nbackend = \"sim\"\n[valve]\nbackend = "
                         "\"none\"\n[[input]]\nid = \"u\"\nrole = \"valve_command\"\nbackend = "
                         "\"sim\"\nchannel = \"u\"\n[sim]\nmodel = \""
                      << shipped("models/thesis_calibrated.toml")
                      << "\"\n[[sim.input]]\nid = \"u\"\nvalue = 1.5\nfrom_s = 0.5\nto_s = "
                         "0.6\nmissing = true\n";
  const Result result = run(virtual_run(file, folder.path() / "log", {"--duration", "1"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const auto& s : read_log(folder.path() / "log").samples) {
    ASSERT_EQ(s.state, 0);
    ASSERT_EQ(s.t_write_ns, 0);
    if (s.tick >= 100 && s.tick < 120) {
      ASSERT_TRUE(std::isnan(s.u_applied_V));
    } else {
      ASSERT_EQ(s.u_applied_V, 1.5);
    }
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
