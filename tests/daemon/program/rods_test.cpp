// Three rod sensors from configuration to alarms: who is out since when, who is in charge, the
// vote of the fault detection, and evidence that leads to the same again.
#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/daemon/program/log.h"
#include "tests/daemon/program/subprocess.h"

namespace program {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr double kTs_s = 0.005;

/// First tick at which an alarm came, in s, and why.
std::pair<double, std::string> came(const Log& log, const std::string& name) {
  for (const auto& alarm : log.alarms) {
    if (alarm.name == name && alarm.active == 1) {
      return {static_cast<double>(alarm.tick) * kTs_s, alarm.reason};
    }
  }
  return {-1.0, ""};
}

TEST(ThreeRods, FailOneAfterTheOtherAndEachIsNamed) {
  const Folder folder;
  const Result result =
      run(virtual_run(shipped("three_rods.toml"), folder.path() / "log", {"--duration", "26"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Log log = read_log(folder.path() / "log");

  // 2 mm/s off the others, which are 0.05 mm off it on the average.
  const auto [first_s, first] = came(log, "rod_rod_out");
  EXPECT_GT(first_s, 8.2);
  EXPECT_LT(first_s, 8.4);
  EXPECT_THAT(first, HasSubstr("off the middle of the others; the controller uses middle"));
  const auto [second_s, second] = came(log, "rod_middle_out");
  EXPECT_GE(second_s, 16.0);
  EXPECT_LT(second_s, 16.2);
  EXPECT_THAT(second, HasSubstr("the controller uses outer"));
  EXPECT_EQ(came(log, "rod_outer_out").first, -1.0) << "with nobody left it is the guard's";
  const auto [latched_s, why] = came(log, "latched");
  EXPECT_NEAR(latched_s, 24.015, 1e-9) << "the fourth missing in a row";
  EXPECT_EQ(why, "position missing: reset, then arm again");

  ASSERT_EQ(log.rods.size(), log.samples.size());
  for (std::size_t k = 0; k < log.samples.size(); ++k) {
    const auto& rods = log.rods[k];
    const auto& sample = log.samples[k];
    ASSERT_EQ(rods.tick, sample.tick);
    ASSERT_EQ(rods.rod, (std::vector<std::string>{"rod", "middle", "outer"}));
    const double t_s = static_cast<double>(rods.tick) * kTs_s;
    const int in_charge = t_s < first_s - 1e-9 ? 0 : t_s < second_s - 1e-9 ? 1 : 2;
    ASSERT_EQ(rods.in_charge, in_charge) << t_s;
    if (t_s < 24.0) {
      ASSERT_EQ(sample.y_m, rods.y_m[static_cast<std::size_t>(in_charge)]);
    }
    ASSERT_EQ(sample.state, t_s < 24.015 - 1e-9 ? 3 : 4) << t_s;
  }

  // The same in the fault detection's own words.
  std::map<std::string, double> named;
  for (const auto& alarm : log.alarms) {
    if (alarm.source == "rods" && alarm.active == 1 && !named.contains(alarm.parameter)) {
      named[alarm.parameter] = static_cast<double>(alarm.tick) * kTs_s;
      if (!alarm.parameter.empty()) {
        EXPECT_EQ(alarm.severity, 2);
      }
    }
  }
  EXPECT_NEAR(named["sample.rod_1_m"], first_s, 0.05);
  EXPECT_TRUE(named.contains("")) << "two that are left and differ";
}

TEST(ThreeRods, LeaveEvidenceThatIsReplayedBitForBit) {
  const Folder folder;
  const Result result = run(virtual_run(
      shipped("three_rods.toml"), folder.path() / "log",
      {"--duration", "14", "--set", "evidence.folder=" + (folder.path() / "evidence").string()}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  int packs = 0;
  for (const auto& pack : fs::directory_iterator(folder.path() / "evidence")) {
    if (pack.path().string().find("rods.channel_out") == std::string::npos) continue;
    ++packs;
    const Result replay = spoolwatch("replay " + pack.path().string() + " --json -");
    EXPECT_EQ(replay.exit_code, 0) << replay.out;
    const auto found = nlohmann::json::parse(replay.out, nullptr, false);
    EXPECT_EQ(found.at("same"), true) << replay.out;
    EXPECT_EQ(found.at("alarm").at("derived"), true) << "the vote was taken anew";
  }
  EXPECT_EQ(packs, 1);
}

TEST(ThreeRods, AreAskedForInOneLineWhereTheyAreNot) {
  const Folder folder;
  const auto refused = [&](const std::string& text) {
    const std::string file = (folder.path() / "rig.toml").string();
    std::ifstream in(shipped("demo.toml"));
    const std::string demo(std::istreambuf_iterator<char>(in), {});
    std::ofstream(file) << demo << text;
    return run(
        {"--config", file, "--check", "--set", "sim.model=" + shipped("models/thesis.toml")});
  };
  Result result = refused(
      "[[voter]]\nid = \"v\"\nchannels = [\"sample.rod_1_m\", "
      "\"sample.rod_2_m\"]\ntolerance = 1e-3\n");
  EXPECT_EQ(result.exit_code, 78);
  EXPECT_THAT(result.err, HasSubstr("[[voter]] v: reads sample.rod_1_m, which the rig does not "
                                    "have; allowed: a [[spare_rod]]"));
  result = refused("[[band]]\nid = \"low\"\nquantity = \"sample.supply_pressure_Pa\"\nlow = 5e6\n");
  EXPECT_EQ(result.exit_code, 78);
  EXPECT_THAT(
      result.err,
      HasSubstr("[[band]] low: reads sample.supply_pressure_Pa, which the rig does not have; "
                "allowed: an [[input]] of role \"supply_pressure\""));
  result = refused("[failover]\ntolerance_m = 1e-3\n");
  EXPECT_EQ(result.exit_code, 78);
  EXPECT_THAT(result.err, HasSubstr("[failover]: has no second rod sensor to switch to"));
  result = refused("[[sim.trouble]]\nkind = \"drift\"\nrod = \"b\"\n");
  EXPECT_EQ(result.exit_code, 78);
  EXPECT_THAT(result.err, HasSubstr("[[sim.trouble]] rod: is \"b\", which is not a [[sim.rod]]"));
}

}  // namespace
}  // namespace program
