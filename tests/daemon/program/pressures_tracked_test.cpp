// With pressures measured the tracker tells the valve's gain from the supply pressure, and its
// evidence leads to the same alarm only with the pressures that were measured.
#include <gmock/gmock.h>

#include <algorithm>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>

#include "tests/daemon/program/log.h"
#include "tests/daemon/program/subprocess.h"

namespace program {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kTs_s = 0.005;

/// The tracker's alarms as they come up, in its order.
std::vector<spoolwatch::alarm_t> raised(const Log& log) {
  std::vector<spoolwatch::alarm_t> raised;
  for (const spoolwatch::alarm_t& alarm : log.alarms) {
    if (alarm.source == "physics" && alarm.repeat == 0 && alarm.active != 0) {
      raised.push_back(alarm);
    }
  }
  return raised;
}

Log watch(const Folder& folder, const std::vector<std::string>& more) {
  std::vector<std::string> arguments =
      virtual_run(shipped("pressures.toml"), folder.path() / "log", {"--duration", "26"});
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Result result = run(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return read_log(folder.path() / "log");
}

/// The log without its pressures.
void strip_pressures(const fs::path& file) {
  const fs::path stripped = file.string() + ".stripped";
  {
    lcm::LogFile in(file.string(), "r");
    lcm::LogFile out(stripped.string(), "w");
    while (const lcm::LogEvent* event = in.readNextEvent()) {
      if (event->channel == "SPOOLWATCH_PRESSURES") continue;
      lcm::LogEvent copy = *event;
      out.writeEvent(&copy);
    }
  }
  fs::rename(stripped, file);
}

TEST(TrackedPressures, NameTheValvesGainAloneAndReplayBitForBit) {
  const Folder folder;
  const fs::path evidence = folder.path() / "evidence";
  const Log log = watch(folder, {"--set", "evidence.folder=" + evidence.string()});
  const std::vector<spoolwatch::alarm_t> alarms = raised(log);
  ASSERT_GE(alarms.size(), 1U);
  for (const spoolwatch::alarm_t& alarm : alarms) {
    EXPECT_EQ(alarm.name, "valve_gain_m_per_V");
    EXPECT_EQ(alarm.parameter, "valve_gain_m_per_V");
    EXPECT_EQ(alarm.parameter_direction, -1);
    EXPECT_LE(alarm.ambiguity_group.size(), 1U) << alarm.reason;
    EXPECT_GT(static_cast<double>(alarm.tick) * kTs_s, 20.0);
  }
  EXPECT_LT(static_cast<double>(alarms[0].tick) * kTs_s, 22.5) << "a window of 2 s, and its step";

  int packs = 0;
  for (const auto& entry : fs::directory_iterator(evidence)) {
    const std::string command = "replay " + entry.path().string() + " --json -";
    const json whole = json::parse(spoolwatch(command).out, nullptr, false);
    ASSERT_TRUE(whole.is_object());
    EXPECT_EQ(whole["same"], true) << whole.dump(1);
    EXPECT_GT(whole["estimates"], 10);
    strip_pressures(entry.path() / "log.lcmlog");
    const json blind = json::parse(spoolwatch(command).out, nullptr, false);
    ASSERT_TRUE(blind.is_object());
    EXPECT_EQ(blind["same"], false) << "the pressures make no difference";
    ++packs;
  }
  EXPECT_GE(packs, 1);
}

TEST(TrackedPressures, AreWhatTellsTheValvesGainApart) {
  const Folder folder;
  std::vector<std::string> unknown;  // read all the same, but nobody knows what they are
  for (const char* input : {"0", "1", "2"}) {
    unknown.insert(unknown.end(), {"--set", std::string("input.") + input + ".role=pressure"});
  }
  const Log log = watch(folder, unknown);
  EXPECT_TRUE(log.pressures.empty());
  for (const spoolwatch::alarm_t& alarm : raised(log)) {
    EXPECT_NE(alarm.parameter, "valve_gain_m_per_V") << alarm.reason;
  }
}

}  // namespace
}  // namespace program
