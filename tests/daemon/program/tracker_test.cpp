// The daemon names the physical parameter that has changed, and its evidence leads to the same
// alarm.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/daemon/program/log.h"
#include "tests/daemon/program/subprocess.h"

namespace program {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::ElementsAre;

/// Those of the tracker that became active, in their order.
std::vector<spoolwatch::alarm_t> raised(const Log& log) {
  std::vector<spoolwatch::alarm_t> raised;
  for (const spoolwatch::alarm_t& alarm : log.alarms) {
    if (alarm.source != "physics" || alarm.repeat != 0 || alarm.active == 0) continue;
    const auto same = [&](const auto& other) { return other.name == alarm.name; };
    if (std::none_of(raised.begin(), raised.end(), same)) raised.push_back(alarm);
  }
  return raised;
}

TEST(Tracker, TellsSupplyPressureAndDampingApartWhereTheSourceCouldNot) {
  const Folder folder;
  const fs::path evidence = folder.path() / "evidence";
  const Result result =
      run(virtual_run(shipped("thesis_case3_named.toml"), folder.path() / "log",
                      {"--duration", "52", "--set", "evidence.folder=" + evidence.string()}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Log log = read_log(folder.path() / "log");
  const std::vector<spoolwatch::alarm_t> alarms = raised(log);
  ASSERT_EQ(alarms.size(), 2u);
  EXPECT_EQ(alarms[0].name, "damping_N_s_per_m");
  EXPECT_EQ(alarms[0].parameter, "damping_N_s_per_m");
  EXPECT_GT(alarms[0].tick, 200 * 15);
  EXPECT_LT(alarms[0].tick, 200 * 17.5);
  EXPECT_EQ(alarms[1].name, "supply_pressure_Pa");
  EXPECT_THAT(alarms[1].ambiguity_group, ElementsAre("supply_pressure_Pa", "valve_gain_m_per_V"));
  EXPECT_GT(alarms[1].tick, 200 * 45);
  EXPECT_LT(alarms[1].tick, 200 * 46);
  int packs = 0;
  for (const auto& entry : fs::directory_iterator(evidence)) {
    const Result replayed = spoolwatch("replay " + entry.path().string() + " --json -");
    const json outcome = json::parse(replayed.out, nullptr, false);
    ASSERT_TRUE(outcome.is_object()) << replayed.out;
    EXPECT_EQ(outcome["same"], true) << entry.path() << outcome.dump(1);
    EXPECT_GT(outcome["estimates"], 20);
    ++packs;
  }
  EXPECT_EQ(packs, 2);
}

TEST(Tracker, RefusesWhatWasLearntWithAnotherModel) {
  const Folder folder;
  const fs::path file = folder.path() / "healthy.toml";
  std::ofstream(file) << R"(
schema_version = 1
healthy_version = 2
model = "another"
model_values = "name = 'another'"
parameters = ["supply_pressure_Pa", "damping_N_s_per_m"]
values = [6.89e6, 1000.0]
sample_time_s = 0.005
window_s = 2.0
observer_per_s = 2.0
rms_m = 2.5e-6
)";
  const Result refused =
      run(virtual_run(shipped("thesis_case3_named.toml"), folder.path() / "log",
                      {"--duration", "1", "--set", "tracker.0.healthy=" + file.string()}));
  EXPECT_EQ(refused.exit_code, 78);
  EXPECT_THAT(refused.err, testing::HasSubstr("[[tracker]] physics: healthy: " + file.string() +
                                              ": model_values: was learned with another model"));
  EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
}

}  // namespace
}  // namespace program
