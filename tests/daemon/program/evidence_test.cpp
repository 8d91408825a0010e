// From an alarm of the daemon to its evidence, and from there to the same alarm: bit for bit, for
// each way to estimate.
#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/daemon/program/log.h"
#include "tests/daemon/program/subprocess.h"

namespace program {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

/// Case I of the thesis with a batch, a sliding window and a recursion, each with its band.
std::string three_ways(const fs::path& folder) {
  const std::string file = (folder / "three.toml").string();
  std::ifstream shipped_file(shipped("thesis_case1.toml"));
  std::string text(std::istreambuf_iterator<char>(shipped_file), {});
  text += R"(
[[estimator]]
id = "recursive"
structure = "arx111"
method = "recursive"
forgetting = 0.99
window_s = 1.0
offset_m = 0.305
warmup_s = 2.0

[[band]]
id = "pressure_recursive"
quantity = "recursive.b1"
low = 0.00018
high = 0.00021
on_delay_s = 0.1
latch = true

[[band]]
id = "far"
quantity = "sample.y_m"
high = 0.32
count = 3
count_window_s = 10.0
chatter_count = 2
)";
  std::ofstream(file) << text;
  return file;
}

std::vector<fs::path> packs_in(const fs::path& folder) {
  std::vector<fs::path> packs;
  for (const auto& entry : fs::directory_iterator(folder)) packs.push_back(entry.path());
  std::sort(packs.begin(), packs.end());
  return packs;
}

json replay(const fs::path& pack, int exit_code = 0) {
  const Result result = spoolwatch("replay " + pack.string() + " --json -");
  EXPECT_EQ(result.exit_code, exit_code) << result.out;
  return json::parse(result.out, nullptr, false);
}

class Evidence : public testing::Test {
 protected:
  void run_case(double before_s) {
    const Result result = run(virtual_run(
        three_ways(folder_.path()), folder_.path() / "log",
        {"--duration", "34", "--set", "evidence.folder=" + evidence().string(), "--set",
         "evidence.before_s=" + std::to_string(before_s), "--set",
         "sim.model=" + shipped("models/thesis_calibrated.toml"), "--set", "sim.noise_m=2e-6"}));
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  [[nodiscard]] fs::path evidence() const { return folder_.path() / "evidence"; }

  Folder folder_;
};

TEST_F(Evidence, OfEachAlarmLeadsToTheSameAlarmBitForBit) {
  run_case(10.0);
  const Log log = read_log(folder_.path() / "log");
  std::vector<std::string> names;
  for (const fs::path& pack : packs_in(evidence())) {
    const json outcome = replay(pack);
    ASSERT_TRUE(outcome.is_object());
    EXPECT_EQ(outcome["same"], true) << pack << outcome.dump(1);
    EXPECT_GT(outcome["estimates"], 500);
    EXPECT_EQ(outcome["estimates"], outcome["estimates_same"]);
    names.push_back(outcome["alarm"]["name"]);
    // Against the daemon's own log: the bits of the alarm's value, at the same sample.
    const auto recorded =
        std::find_if(log.alarms.begin(), log.alarms.end(), [&](const spoolwatch::alarm_t& alarm) {
          return alarm.name == names.back() && alarm.tick == outcome["alarm"]["tick"] &&
                 alarm.active != 0 && alarm.repeat == 0;
        });
    ASSERT_NE(recorded, log.alarms.end()) << pack;
    const std::string bits = outcome["alarm"]["value_bits"];
    EXPECT_EQ(std::stoull(bits, nullptr, 16), std::bit_cast<std::uint64_t>(recorded->value));
  }
  EXPECT_THAT(names, testing::IsSupersetOf(
                         {"supply_pressure", "supply_pressure_fast", "pressure_recursive", "far"}));
}

TEST_F(Evidence, AndTheLogShowTheLifeOfAnAlarm) {
  run_case(10.0);
  const Log log = read_log(folder_.path() / "log");
  std::string life;
  bool repeated_latched = false;
  for (const spoolwatch::alarm_t& alarm : log.alarms) {
    if (alarm.name != "pressure_recursive") continue;
    EXPECT_EQ(alarm.acknowledged, 0);
    EXPECT_EQ(alarm.shelved, 0);
    if (alarm.repeat != 0) {
      repeated_latched = repeated_latched || alarm.latched != 0;
    } else {
      life += alarm.latched != 0 ? "latched " : alarm.active != 0 ? "active " : "normal ";
    }
  }
  EXPECT_EQ(life, "active latched ") << "the pressure is normal again at 30 s";
  EXPECT_TRUE(repeated_latched) << "it is still active";
  int first = 0;
  for (const spoolwatch::alarm_t& alarm : log.alarms) first += alarm.first_up && !alarm.repeat;
  EXPECT_GE(first, 1);
  std::map<std::string, bool> active;
  for (const spoolwatch::alarm_t& alarm : log.alarms) active[alarm.name] = alarm.active != 0;
  const auto count = std::count_if(active.begin(), active.end(), [](auto& a) { return a.second; });
  EXPECT_EQ(log.healths.back().active_alarms, count);
}

TEST_F(Evidence, BeginsBeforeTheAlarmAndEndsAfterItAtFullRate) {
  run_case(4.0);
  for (const fs::path& pack : packs_in(evidence())) {
    std::ifstream in(pack / "pack.json");
    const json manifest = json::parse(in);
    const fs::path alone = folder_.path() / "alone";
    fs::create_directory(alone);
    fs::copy_file(pack / "log.lcmlog", alone / "log.lcmlog");
    const Log log = read_log(alone);
    fs::remove_all(alone);
    const std::int64_t tick = manifest["alarm"]["tick"];
    EXPECT_LE(log.samples.front().tick, std::max<std::int64_t>(0, tick - 800)) << pack;
    EXPECT_GE(log.samples.front().tick, tick - 800 - 400) << "snapshots come each 2 s";
    EXPECT_GE(log.samples.back().tick, std::min<std::int64_t>(tick + 1000, 6799)) << pack;
    for (std::size_t i = 1; i < log.samples.size(); ++i) {
      ASSERT_EQ(log.samples[i].tick, log.samples[i - 1].tick + 1);
    }
    EXPECT_TRUE(fs::exists(pack / "model.toml"));
    EXPECT_TRUE(fs::exists(pack / "configuration.toml"));
    for (const auto& entry : fs::directory_iterator(pack)) {
      std::ifstream file(entry.path(), std::ios::binary);
      const std::string text(std::istreambuf_iterator<char>(file), {});
      EXPECT_EQ(text.find(folder_.path().string()), std::string::npos)
          << entry.path() << " tells where the daemon keeps its files";
    }
  }
}

TEST_F(Evidence, ThatWasTouchedIsNotTheSame) {
  run_case(10.0);
  const fs::path pack = packs_in(evidence()).at(1);
  const auto text_of = [](const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const auto write = [](const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
  };
  const std::string state = text_of(pack / "state.bin");
  std::string touched = state;
  touched[touched.size() / 2] = static_cast<char>(touched[touched.size() / 2] ^ 1);
  write(pack / "state.bin", touched);
  EXPECT_THAT(spoolwatch("replay " + pack.string()).out, HasSubstr("damaged"));
  write(pack / "state.bin", state);
  const std::string rules = text_of(pack / "pipeline.toml");
  write(pack / "pipeline.toml", rules + "# another\n");
  EXPECT_THAT(spoolwatch("replay " + pack.string()).out, HasSubstr("of another configuration"));
  write(pack / "pipeline.toml", rules);
  // The last bit of one position: event header 28, channel 17, then 64 bytes to sample_time_s.
  std::string log = text_of(pack / "log.lcmlog");
  const std::size_t y_at = 28 + 17 + 8 + 7 * 8 + 2 * 8 + 7;
  log[y_at] = static_cast<char>(log[y_at] ^ 1);
  write(pack / "log.lcmlog", log);
  const json outcome = replay(pack, 1);
  EXPECT_EQ(outcome["same"], false);
  EXPECT_LT(outcome["estimates_same"], outcome["estimates"]);
}

TEST_F(Evidence, WhatIsNoneIsOneLineAndExitCode65) {
  const Result none = spoolwatch("replay " + folder_.path().string());
  EXPECT_EQ(none.exit_code, 65);
  EXPECT_EQ(std::count(none.out.begin(), none.out.end(), '\n'), 1) << none.out;
  EXPECT_THAT(none.out, HasSubstr("pack.json: cannot be read"));
}

}  // namespace
}  // namespace program
