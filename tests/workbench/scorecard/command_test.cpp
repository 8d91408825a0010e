// The command: figures of a small plan, going on from a file, the page, and what it refuses.
#include <gmock/gmock.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "config/schema/error.h"
#include "tests/workbench/present/page_check.h"
#include "tests/workbench/run_command.h"

namespace {

using nlohmann::json;
using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* kPlan = R"(schema_version = 1
model = ")" SPOOLWATCH_SOURCE_DIR R"(/config/models/thesis_calibrated.toml"
lead_s = 5.0
phase_s = 2.0
watch_s = 6.0
training_s = 120.0
healthy_h = 0.02
benign_h = 0.01
part_h = 0.01
[instruments]
encoder_resolution_m = 5e-6
noise_m = 2e-6
dac_bits = 12
[[motion]]
id = "sine"
kind = "sine"
[[fault]]
id = "supply_pressure"
parameter = "supply_pressure_Pa"
stated = 20.0
least = 1.0
greatest = 50.0
[[benign]]
id = "load"
parameter = "mass_kg"
factor = 1.1
)";

std::string method(const std::string& name, const std::string& limits) {
  return "schema_version = 1\nname = \"" + name +
         "\"\nfalse_alarm_time_s = 3600.0\n[[estimator]]\nid = \"p\"\nwindow_s = 2.0\n"
         "offset_m = 0.305\nwarmup_s = 4.0\n[[band]]\nid = \"gain\"\nquantity = \"p.b1\"\n"
         "parameter = \"supply_pressure_Pa\"\n" +
         limits;
}

class ScorecardCommand : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(testing::TempDir()) /
        ("scorecard_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write("plan.toml", kPlan);
    write("printed.toml", method("printed", "low = 1.8e-4\nhigh = 2.1e-4\n"));
    write("learned.toml", method("learned", ""));
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
  }
  std::string text(const std::string& name) const {
    return workbench::present::read_text(file(name));
  }
  json json_of(const std::string& name) const { return json::parse(text(name)); }
  std::string run(std::vector<std::string> arguments) const {
    for (const char* word : {"--seeds", "5", "--threads", "2", "--plan"}) {
      arguments.emplace_back(word);
    }
    arguments.push_back(file("plan.toml"));
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    try {
      code_ = workbench_test::run_command(workbench::cli::add_scorecard, arguments);
    } catch (...) {
      testing::internal::GetCapturedStdout();
      testing::internal::GetCapturedStderr();
      throw;
    }
    testing::internal::GetCapturedStderr();
    return testing::internal::GetCapturedStdout();
  }
  std::string refusal(const std::vector<std::string>& arguments) const {
    try {
      run(arguments);
    } catch (const config::schema::Error& error) {
      code_ = config::schema::exit_code_of(error);
      return error.what();
    }
    return "";
  }

  fs::path folder_;
  mutable int code_ = 0;
};

TEST_F(ScorecardCommand, PrintsAndWritesTheFigures) {
  const std::string shown =
      run({file("printed.toml"), file("learned.toml"), "--json", file("out.json"), "--details"});
  EXPECT_EQ(code_, 0);
  EXPECT_THAT(shown, HasSubstr("smallest fault detected"));
  EXPECT_THAT(shown, HasSubstr("supply pressure, ±20 %"));
  const json card = json_of("out.json");
  EXPECT_EQ(card["schema_version"], 1);
  EXPECT_EQ(card["complete"], true);
  ASSERT_EQ(card["methods"].size(), 2U);
  const json& printed = card["methods"][0];
  const json& learned = card["methods"][1];
  EXPECT_EQ(printed["name"], "printed");
  EXPECT_NEAR(printed["healthy"]["hours"].get<double>(), 0.02, 1e-12);
  EXPECT_EQ(printed["healthy"]["alarms"], 0);
  // -ln(0.05) / 0.02 h
  EXPECT_NEAR(printed["healthy"]["per_hour_upper_95"].get<double>(), 149.787, 1e-2);
  // The band is 7 % of b1 up and 9 % down, b1 goes by the root of the pressure: +14 %, -16 %.
  const json& of = printed["faults"][0];
  EXPECT_NEAR(of["smallest"]["sine"]["up"].get<double>(), 15.0, 1e-9);
  EXPECT_NEAR(of["smallest"]["sine"]["down"].get<double>(), 20.0, 1e-9);
  EXPECT_LT(learned["faults"][0]["smallest"]["sine"]["up"].get<double>(), 5.0);
  EXPECT_EQ(of["trials"], 10);
  EXPECT_EQ(of["verdicts"]["right"], 10);
  EXPECT_EQ(printed["matrix"]["supply_pressure"]["supply_pressure_Pa"], 10);
  // A batch of 2 s that the fault came into: at most two of them.
  EXPECT_GT(of["delay_s"]["median"].get<double>(), 0.0);
  EXPECT_LT(of["delay_s"]["p95"].get<double>(), 4.0);
}

TEST_F(ScorecardCommand, GivesTheSameFiguresForTheSameSeedAndThreads) {
  const auto figures = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{file("learned.toml"), "--json", file("out.json")};
    words.insert(words.end(), more.begin(), more.end());
    run(words);
    json card = json_of("out.json");
    card.erase("runtime_s");
    card["methods"][0].erase("load_ratio");
    return card;
  };
  const json first = figures({});
  EXPECT_EQ(figures({}), first);
  EXPECT_NE(figures({"--seed", "2"}), first);
}

TEST_F(ScorecardCommand, GoesOnFromWhatIsDone) {
  const std::vector<std::string> resume{"--resume", file("done.json"), "--json", file("out.json")};
  const auto with = [&](std::vector<std::string> words) {
    words.insert(words.end(), resume.begin(), resume.end());
    return words;
  };
  run(with({file("printed.toml")}));
  const json whole = json_of("out.json");
  json done = json_of("done.json");
  ASSERT_EQ(done["results"].size(), 7U);  // two of each: stated, ladder, healthy; one benign

  // Results that are there are not computed again, missing ones are.
  json& stated = done["results"]["stated/supply_pressure/up/sine"];
  for (json& result : stated) {
    for (json& answer : result["answers"]) answer["first"] = {"from_the_file"};
  }
  done["results"].erase("ladder/supply_pressure/up/sine");
  write("done.json", done.dump());
  run(with({file("printed.toml"), file("learned.toml")}));
  const json again = json_of("out.json");
  const json& matrix = again["methods"][0]["matrix"]["supply_pressure"];
  EXPECT_EQ(matrix["from_the_file"], 5);
  EXPECT_EQ(matrix["supply_pressure_Pa"], 5);
  EXPECT_EQ(again["methods"][0]["faults"], whole["methods"][0]["faults"]);
  EXPECT_EQ(again["methods"][1]["faults"][0]["trials"], 10);

  EXPECT_THAT(refusal(with({file("printed.toml"), "--seed", "9"})), HasSubstr("another plan"));
  EXPECT_EQ(code_, 78);
}

TEST_F(ScorecardCommand, RefusesWhatItCannotUse) {
  EXPECT_THAT(refusal({"no_such_method"}), HasSubstr("thesis_thresholds"));
  EXPECT_EQ(code_, 78);
  write("bad.toml", method("bad", "") + "[[band]]\nid = \"x\"\nquantity = \"p.b9\"\n");
  EXPECT_THAT(refusal({file("bad.toml")}), HasSubstr("b9"));
  EXPECT_EQ(code_, 78);
  EXPECT_THAT(refusal({file("learned.toml"), file("learned.toml")}), HasSubstr("another method"));
  EXPECT_EQ(code_, 78);
  EXPECT_THAT(refusal({file("learned.toml"), "--fault", "x"}), HasSubstr("supply_pressure"));
  EXPECT_EQ(code_, 2);
  write("torn.json", "{\"results\":");
  EXPECT_THAT(refusal({file("learned.toml"), "--resume", file("torn.json")}), HasSubstr("torn"));
  EXPECT_EQ(code_, 65);
  EXPECT_THAT(refusal({file("learned.toml"), "--json", file("no/such/folder.json")}),
              HasSubstr("folder"));
  EXPECT_EQ(code_, 1);
}

TEST_F(ScorecardCommand, SaysWhichMotionAMethodCannotLearn) {
  write("deaf.toml", method("deaf", ""));
  std::string deaf = text("deaf.toml");
  deaf.replace(deaf.find("warmup_s"), 0, "min_u_rms_V = 100.0\n");
  write("deaf.toml", deaf);
  run({file("deaf.toml"), "--json", file("out.json")});
  EXPECT_THAT(json_of("out.json")["methods"][0]["unusable"]["sine"].get<std::string>(),
              HasSubstr("p.b1"));
}

TEST_F(ScorecardCommand, ThePageDrawsEveryPlotWithoutARequest) {
  if (!workbench::present::have_browser()) {
    GTEST_SKIP() << "chromium is missing: scripts/install-packages browser";
  }
  run({file("printed.toml"), file("learned.toml"), "--report", file("page.html")});
  const workbench::present::Visit seen =
      workbench::present::visit(workbench::present::with_check(text("page.html"), false));
  const json check = workbench::present::check_of(seen);
  ASSERT_TRUE(check.contains("drawn")) << check.dump();
  EXPECT_THAT(seen.requests, testing::IsEmpty());
  EXPECT_THAT(check["errors"], testing::IsEmpty()) << check["errors"].dump();
  EXPECT_THAT(check["cut"], testing::IsEmpty()) << check["cut"].dump();
  EXPECT_EQ(check["drawn"], 3);  // false alarms, smallest, delay
  EXPECT_EQ(check["declared"], 3);
  EXPECT_LE(check["width"].get<int>(), 1366) << "the page is wider than a laptop's screen";
}

}  // namespace
