// New rules on logs that the daemon wrote: case I of the thesis, alarms at 18 s and 48 s.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/daemon/program/subprocess.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using program::Result;
using program::spoolwatch;
using testing::HasSubstr;

class Backtest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new program::Folder;
    for (const auto& [name, bytes] : {std::pair{"whole", "67108864"}, {"parts", "400000"}}) {
      const Result result = program::run(program::virtual_run(
          program::shipped("thesis_case1.toml"), log(name),
          {"--duration", "60", "--set", std::string("recorder.file_bytes=") + bytes}));
      ASSERT_EQ(result.exit_code, 0) << result.err;
    }
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static std::string log(const std::string& name) { return (folder_->path() / name).string(); }

  /// The shipped configuration with `from` replaced by `to` everywhere.
  static std::string changed(const std::string& from, const std::string& to) {
    std::ifstream in(program::shipped("thesis_case1.toml"));
    std::string text(std::istreambuf_iterator<char>(in), {});
    for (std::size_t at = text.find(from); at != std::string::npos;
         at = text.find(from, at + to.size())) {
      text.replace(at, from.size(), to);
    }
    const std::string file = log("changed.toml");
    std::ofstream(file) << text;
    return file;
  }
  static json backtest(const std::string& words, int exit_code = 0) {
    const Result result = spoolwatch("backtest " + words + " --json -");
    EXPECT_EQ(result.exit_code, exit_code) << result.out;
    return json::parse(result.out, nullptr, false);
  }

  static inline program::Folder* folder_ = nullptr;
};

TEST_F(Backtest, OfTheSameRulesFindsWhatWasRecorded) {
  const json all = backtest(program::shipped("thesis_case1.toml") + " " + log("whole"));
  ASSERT_TRUE(all.is_object());
  EXPECT_EQ(all["total"], json::parse(R"({"appear":0,"disappear":0,"shift":0,"same":4})"));
  EXPECT_EQ(all["compared_with"], "recorded");
  ASSERT_EQ(all["runs"].size(), 1U);
  // The source's alarm: window 8 (16 s to 18 s) ends with sample 3599.
  for (const json& alarm : all["runs"][0]["alarms"]) {
    if (alarm["alarm"] != "period.supply_pressure" || alarm["from_s"] > 30.0) continue;
    EXPECT_NEAR(alarm["from_s"].get<double>(), 17.995, 1e-9);
    EXPECT_EQ(alarm["direction"], 1);
  }
}

TEST_F(Backtest, PutsTheFilesOfOneRunTogether) {
  ASSERT_GT(std::distance(fs::directory_iterator(log("parts")), fs::directory_iterator()), 4);
  const json all = backtest(program::shipped("thesis_case1.toml") + " " + log("parts"));
  ASSERT_TRUE(all.is_object());
  ASSERT_EQ(all["runs"].size(), 1U);
  EXPECT_EQ(all["total"]["same"], 4);
  EXPECT_EQ(all["runs"][0]["samples"], 12001);
}

TEST_F(Backtest, NamesWhatDisappearsAndWhatAppears) {
  // b1 of a pressure 25 % higher is 12 % higher: 2.2e-4.
  const std::string wide = changed("high = 0.00021", "high = 0.00025");
  const json less = backtest(wide + " " + log("whole"));
  ASSERT_TRUE(less.is_object());
  EXPECT_EQ(less["total"], json::parse(R"({"appear":0,"disappear":2,"shift":0,"same":2})"));
  for (const json& gone : less["runs"][0]["disappears"]) {
    EXPECT_EQ(gone["direction"], 1);
    EXPECT_LT(gone["from_s"], 20.0);
  }
  // The other way round, and against the rules themselves instead of what was recorded.
  const json more =
      backtest(program::shipped("thesis_case1.toml") + " " + log("whole") + " --old " + wide);
  EXPECT_EQ(more["total"], json::parse(R"({"appear":2,"disappear":0,"shift":0,"same":2})"));
  EXPECT_THAT(spoolwatch("backtest " + wide + " " + log("whole")).out,
              HasSubstr("disappears  period.supply_pressure high, 17.995 s to 31.995 s"));
}

TEST_F(Backtest, SaysByHowMuchAnAlarmShifts) {
  const std::string later = changed("off_delay_s = 0.5", "off_delay_s = 0.5\non_delay_s = 0.2");
  const json all = backtest(later + " " + log("whole"));
  ASSERT_TRUE(all.is_object());
  EXPECT_EQ(all["total"], json::parse(R"({"appear":0,"disappear":0,"shift":2,"same":2})"));
  for (const json& shift : all["runs"][0]["shifts"]) {
    EXPECT_NEAR(shift["shift_s"].get<double>(), 0.2, 1e-9);
  }
}

TEST_F(Backtest, TakesARecordWithoutAlarms) {
  const fs::path csv = folder_->path() / "record.csv";
  ASSERT_EQ(spoolwatch("export " + log("whole") + "/*.lcmlog -o " + csv.string()).exit_code, 0);
  const json all = backtest(program::shipped("thesis_case1.toml") + " " + csv.string());
  ASSERT_TRUE(all.is_object());
  EXPECT_EQ(all["total"], json::parse(R"({"appear":4,"disappear":0,"shift":0,"same":0})"));
  EXPECT_THAT(
      spoolwatch("backtest " + program::shipped("thesis_case1.toml") + " " + csv.string()).out,
      HasSubstr("no alarms were recorded here"));
}

TEST_F(Backtest, RefusesBadInputWithOneLine) {
  const std::string rules = program::shipped("thesis_case1.toml");
  EXPECT_EQ(spoolwatch("backtest " + rules).exit_code, 2);
  EXPECT_EQ(spoolwatch("backtest " + rules + " /tmp/no/such/log").exit_code, 65);
  EXPECT_EQ(spoolwatch("backtest " + rules + " " + folder_->path().string()).exit_code, 65);
  EXPECT_EQ(spoolwatch("backtest " + rules + " " + log("whole") + " --flip").exit_code, 2);
  EXPECT_EQ(spoolwatch("backtest /tmp/no/such.toml " + log("whole")).exit_code, 78);
  EXPECT_EQ(
      spoolwatch("backtest " + program::shipped("bench_rig.toml") + " " + log("whole")).exit_code,
      78);
}

}  // namespace
