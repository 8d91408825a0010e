// `spoolwatch diagnose` from the record to its files.
#include <gmock/gmock.h>

#include <csignal>
#include <thread>

#include "config/schema/error.h"
#include "plant_sim/model_file.h"
#include "tests/workbench/diagnose/servo_bench.h"

namespace workbench::diagnose {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// Some of its own standard errors.
constexpr double kErrors = 4.0;

class DiagnoseCommand : public testing::Test, public ServoBench {
 protected:
  int run(std::vector<std::string> arguments) {
    testing::internal::CaptureStdout();
    int code = -1;
    std::string thrown;
    try {
      code = diagnose_with(std::move(arguments));
    } catch (const std::exception& error) {
      thrown = error.what();
    }
    text_ = testing::internal::GetCapturedStdout();
    EXPECT_EQ(thrown, "");
    return code;
  }
  std::string text_;
};

TEST_F(DiagnoseCommand, FindsTheOffsetAndWritesJsonModelAndReport) {
  const std::string bench = record("bench.csv", {.offset_V = 0.04});
  ASSERT_EQ(run({model(), bench, "--json", file("d.json"), "-o", file("better.toml"), "--report",
                 file("d.html")}),
            0);
  const json j = json_of(file("d.json"));
  EXPECT_THAT(j["missing"].get<std::vector<std::string>>(), ElementsAre("null_bias")) << text_;
  EXPECT_TRUE(j["refined"].empty()) << "the file has no part of it";
  const json& offset = j["parameters"]["null_bias.offset_V"];
  EXPECT_NEAR(offset["value"].get<double>(), 0.04, kErrors * offset["std_error"].get<double>());
  EXPECT_LT(j["rms_after_m"].get<double>(), 0.1 * j["rms_before_m"].get<double>());
  EXPECT_LT(j["free_run_after_m"].get<double>(), 0.1 * j["free_run_before_m"].get<double>());
  plant_sim::ModelFile better = plant_sim::load_model(file("better.toml"));
  EXPECT_EQ(*better.value("null_bias.offset_V"), offset["value"].get<double>());
  EXPECT_EQ(*better.value("gain_mps_per_V"),
            j["parameters"]["gain_mps_per_V"]["value"].get<double>());
  EXPECT_THAT(text_of(file("better.toml")), HasSubstr("# Missing: null_bias: offset "));
  EXPECT_THAT(text_, HasSubstr("next: spoolwatch compare " + file("better.toml") + " " + bench));
  const std::string page = text_of(file("d.html"));
  for (const char* part : {"Missing: null_bias", "The falling error", "The candidates",
                           "Residual before against velocity", "Residual before", "noise floor",
                           "spoolwatch diagnose"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
}

TEST_F(DiagnoseCommand, HealthyServoLacksNothingAndItsModelIsWrittenWithFittedParameters) {
  const std::string bench = record("bench.csv", {});
  ASSERT_EQ(run({model(), bench, "--json", file("d.json"), "-o", file("better.toml"), "--report",
                 file("d.html")}),
            0);
  EXPECT_EQ(json_of(file("d.json"))["verdict"], "nothing_missing") << text_;
  EXPECT_THAT(text_, HasSubstr("Nothing is missing"));
  plant_sim::ModelFile better = plant_sim::load_model(file("better.toml"));
  // 1 mm of travel seen to 2 um many hundred times.
  EXPECT_NEAR(*better.value("gain_mps_per_V"), 0.0505, 0.0505 * 1e-3);
  EXPECT_THAT(text_of(file("better.toml")), HasSubstr("# Nothing is missing"));
}

TEST_F(DiagnoseCommand, HeldOutRecordAtAnotherRateOnlyScores) {
  const std::string bench = record("bench.csv", {.offset_V = 0.04});
  const std::string other =
      record("other.csv", {.offset_V = 0.04, .sample_time_s = 0.01, .seed = 2});
  ASSERT_EQ(run({model(), bench, "--holdout", other, "--json", file("d.json"), "--report",
                 file("d.html")}),
            0);
  const json j = json_of(file("d.json"));
  EXPECT_THAT(j["missing"].get<std::vector<std::string>>(), ElementsAre("null_bias"));
  EXPECT_THAT(j["holdouts"].get<std::vector<std::string>>(), ElementsAre(other));
  EXPECT_THAT(text_of(file("d.html")), HasSubstr("Held out: other.csv"));
}

TEST_F(DiagnoseCommand, RecordWithoutMotionIsNotExcitedAndLeavesNoModel) {
  const std::string still = record("still.csv", {.amplitude_V = 0.0});
  testing::internal::CaptureStderr();
  ASSERT_EQ(run({model(), still, "--json", file("d.json"), "-o", file("better.toml"), "--report",
                 file("d.html")}),
            0);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("there is no better model"));
  const json j = json_of(file("d.json"));
  EXPECT_EQ(j["verdict"], "not_excited");
  EXPECT_EQ(j["rms_after_m"], nullptr);
  EXPECT_NE(j["advice"], "");
  EXPECT_THAT(text_, HasSubstr("The record cannot tell: "));
  EXPECT_FALSE(std::filesystem::exists(file("better.toml")));
  EXPECT_THAT(text_of(file("d.html")), HasSubstr("The record cannot tell"));
}

TEST_F(DiagnoseCommand, PositionThatNeverChangesIsNotExcited) {
  config::record::Record still;
  for (int k = 0; k < 1000; ++k) {
    still.t_s.push_back(0.005 * k);
    still.u_V.push_back(std::sin(0.01 * k));
    still.y_m.push_back(0.3);
  }
  config::record::write_csv(still, file("still.csv"));
  ASSERT_EQ(run({model(), file("still.csv"), "--json", file("d.json")}), 0);
  EXPECT_EQ(json_of(file("d.json"))["verdict"], "not_excited");
}

TEST_F(DiagnoseCommand, JsonOnStandardOutputIsAloneThere) {
  const std::string bench = record("bench.csv", {});
  ASSERT_EQ(run({model(), bench, "--json", "-"}), 0);
  EXPECT_EQ(json::parse(text_)["records"][0], bench);
}

TEST_F(DiagnoseCommand, AssignmentsChangeTheModelForThisRun) {
  const std::string bench = record("bench.csv", {.offset_V = 0.04});
  ASSERT_EQ(
      run({model(), bench, "--set", "effects.null_bias.offset_V=0.03", "--json", file("d.json")}),
      0);
  const json j = json_of(file("d.json"));
  EXPECT_EQ(j["verdict"], "nothing_missing") << text_;  // it is in the model, and fitted
  EXPECT_NEAR(j["parameters"]["null_bias.offset_V"]["value"].get<double>(), 0.04, 1e-3);
}

TEST_F(DiagnoseCommand, InterruptedRunKeepsTheBestSoFarAndSaysSo) {
  const std::string bench = record("bench.csv", {.offset_V = 0.04, .duration_s = 60.0});
  signal(SIGINT, SIG_DFL);  // background jobs of a shell ignore it
  int code = 0;
  {
    const std::jthread user([](const std::stop_token& over) {
      struct sigaction now {};
      while (sigaction(SIGINT, nullptr, &now) == 0 && now.sa_handler == SIG_DFL) {
        if (over.stop_requested()) return;
        std::this_thread::yield();
      }
      kill(getpid(), SIGINT);
    });
    code = run({model(), bench, "--json", file("d.json"), "-o", file("better.toml")});
  }
  EXPECT_EQ(code, 128 + SIGINT);
  EXPECT_EQ(json_of(file("d.json"))["interrupted"], true);
  EXPECT_THAT(text_, HasSubstr("Interrupted: this is the best so far"));
  EXPECT_THAT(text_, Not(HasSubstr("o effect of the library")));
  EXPECT_THAT(text_of(file("better.toml")), HasSubstr("# INTERRUPTED"));
  EXPECT_NO_THROW((void)plant_sim::load_model(file("better.toml")));
  struct sigaction after {};
  sigaction(SIGINT, nullptr, &after);
  EXPECT_EQ(after.sa_handler, SIG_DFL);
}

}  // namespace
}  // namespace workbench::diagnose
