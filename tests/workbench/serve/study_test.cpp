// The page shows what the commands print: the same figures, and command lines that repeat them.
#include <gmock/gmock.h>

#include "tests/workbench/run_command.h"
#include "tests/workbench/serve/loopback.h"
#include "workbench/present/text.h"
#include "workbench/serve/lane.h"
#include "workbench/serve/study.h"

namespace workbench::serve {
namespace {

using nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;

const std::filesystem::path kTour = std::filesystem::path(SPOOLWATCH_SOURCE_DIR) / "config/tour";

class StudyPage : public testing::Test {
 protected:
  void SetUp() override {
    page.log_in();
    std::filesystem::copy(kTour / "multisine.csv", page.session);
    ASSERT_EQ(page.post("record", {{"name", "multisine.csv"}}).status, 200);
    ASSERT_EQ(page.post("shipped", {{"name", "thesis.toml"}}).status, 200);
  }
  std::string path(const std::string& name) const { return (page.session / name).string(); }
  ordered_json printed(cli::Setup setup, std::vector<std::string> arguments) const {
    return ordered_json::parse(workbench_test::printed_by(setup, std::move(arguments)));
  }
  ordered_json finished() const {
    for (int i = 0; i < 600; ++i) {
      const ordered_json state = page.state();
      if (!state["running"].get<bool>() && !state["result"].is_null()) return state;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return {};
  }
  ServedFolder page;
};

TEST_F(StudyPage, ShowsTheFiguresOfCompare) {
  const ordered_json shown = page.state()["shown"];
  const ordered_json compared =
      printed(cli::add_compare, {path("thesis.toml"), path("multisine.csv"), "--json", "-"});
  EXPECT_EQ(shown["rms_m"], compared["rms_m"]);
  EXPECT_EQ(shown["noise_floor_m"], compared["noise_floor_m"]);
  EXPECT_EQ(shown["verdict"], present::typeset(compared["verdict"].get<std::string>()));
  EXPECT_EQ(shown["command"], "spoolwatch compare thesis.toml multisine.csv");
  EXPECT_THAT(shown["regions"][0]["where"].get<std::string>(), HasSubstr("reversing"));
  EXPECT_GT(shown["regions"][0]["spans"].size(), 5U);
}

TEST_F(StudyPage, TheHeldOutErrorIsThatOfAFitOnBlocks) {
  const ordered_json fitted =
      printed(cli::add_fit, {path("thesis.toml"), path("multisine.csv"), "--fit", "blocks",
                             "--profile", "none", "--quiet", "--json", "-"});
  EXPECT_NEAR(page.state()["shown"]["heldout_m"].get<double>(),
              fitted["heldout_before_m"].get<double>(),
              1e-9 * fitted["heldout_before_m"].get<double>());
}

TEST_F(StudyPage, ASliderShowsWhatCompareSaysOfTheSameValue) {
  const Answer answer = page.post("preview", {{"values", {{"mass_kg", 40.0}}}, {"rows", 4000}});
  ASSERT_EQ(answer.status, 200) << answer.body;
  const ordered_json preview = ordered_json::parse(answer.body);
  EXPECT_EQ(preview["command"],
            "spoolwatch compare thesis.toml multisine.csv --set parameters.mass_kg=40");
  const ordered_json compared =
      printed(cli::add_compare, {path("thesis.toml"), path("multisine.csv"), "--set",
                                 "parameters.mass_kg=40", "--json", "-"});
  // Seven digits go to the page.
  EXPECT_NEAR(preview["rms_m"].get<double>(), compared["rms_m"].get<double>(),
              1e-6 * compared["rms_m"].get<double>());
  const ordered_json curves = ordered_json::parse(page.post("curves", {{"rows", 4000}}).body);
  EXPECT_EQ(preview["error"].size(), curves["t"].size()) << "drawn over the page's own times";
  EXPECT_EQ(page.post("preview", {{"values", {{"mass_kg", -1.0}}}}).status, 422);
  EXPECT_EQ(page.post("preview", {{"values", {{"nothing", 1.0}}}}).status, 422);
}

TEST_F(StudyPage, WhatIsLeftOutIsIgnoredAndCanBeCountedAgain) {
  const ordered_json whole = page.state()["shown"];
  ASSERT_EQ(page.post("ignore", {{"spans", {"3:5"}}}).status, 200);
  const ordered_json part = page.state();
  EXPECT_EQ(part["shown"]["command"], "spoolwatch compare thesis.toml multisine.csv --ignore 3:5");
  EXPECT_EQ(part["shown"]["rms_m"],
            printed(cli::add_compare, {path("thesis.toml"), path("multisine.csv"), "--ignore",
                                       "3:5", "--json", "-"})["rms_m"]);
  EXPECT_EQ(page.post("ignore", {{"spans", {"900:901"}}}).status, 422);
  EXPECT_EQ(page.state()["ignored"], part["ignored"]) << "a refused request changes nothing";
  ASSERT_EQ(page.post("ignore", {{"spans", ordered_json::array()}}).status, 200);
  EXPECT_EQ(page.state()["shown"]["rms_m"], whole["rms_m"]);
}

TEST_F(StudyPage, ADiagnosisBecomesATrialThatIsAcceptedAndUndone) {
  ASSERT_EQ(page.post("diagnose").status, 200);
  EXPECT_EQ(page.post("fit").status, 422) << "one computation at a time";
  const ordered_json found = finished();
  EXPECT_EQ(found["trial"], "thesis-diagnosed.toml");
  EXPECT_EQ(found["result"]["verdict"], "missing");
  EXPECT_LT(found["shown"]["heldout_m"].get<double>(),
            1.2 * found["shown"]["noise_floor_m"].get<double>());
  EXPECT_EQ(found["commands"].back(),
            "spoolwatch diagnose thesis.toml multisine.csv -o thesis-diagnosed.toml");
  ASSERT_EQ(page.post("accept").status, 200);
  EXPECT_EQ(page.state()["model"], "thesis-diagnosed.toml");
  ASSERT_EQ(page.post("undo").status, 200);
  EXPECT_EQ(page.state()["model"], "thesis.toml");
  EXPECT_EQ(page.post("undo").status, 422);
  EXPECT_EQ(page.state()["lineage"].size(), 2U) << "what was tried stays in the tree";
  EXPECT_TRUE(std::filesystem::exists(page.session / "thesis-diagnosed.toml"));
}

TEST_F(StudyPage, AnEffectAddedByHandHasSlidersAndIsFitted) {
  ASSERT_EQ(page.post("add", {{"effect", "null_bias"}}).status, 200);
  const ordered_json added = page.state();
  EXPECT_EQ(added["trial"], "thesis+null_bias.toml");
  EXPECT_THAT(added["commands"].back().get<std::string>(),
              HasSubstr("spoolwatch add thesis.toml null_bias offset_V="));
  EXPECT_EQ(added["parameters"].back()["name"], "null_bias.offset_V");
  ASSERT_EQ(page.post("fit", {{"values", {{"null_bias.offset_V", 0.05}}}}).status, 200);
  const ordered_json fitted = finished();
  EXPECT_EQ(fitted["trial"], "thesis+null_bias-fitted.toml");
  EXPECT_LT(fitted["shown"]["rms_m"].get<double>(), 1e-4);
}

TEST_F(StudyPage, ASessionGoesOnWhereItEnded) {
  ASSERT_EQ(page.post("ignore", {{"spans", {"3:5"}}}).status, 200);
  const SessionFolder folder(page.session);
  Study again(folder);
  const ordered_json state = again.state();
  EXPECT_EQ(state["record"], "multisine.csv");
  EXPECT_EQ(state["model"], "thesis.toml");
  EXPECT_THAT(state["ignored"], ElementsAre("3:5"));
  page.put("session.json", "{\"nodes\": [1, {\"model\": 3}], \"record\": []}");
  EXPECT_EQ(Study(folder).state()["record"], "");
}

TEST(Lane, OnlyTheLatestOfWhatWaitsIsDone) {
  std::string done;
  std::atomic<bool> begun{false};
  std::atomic<bool> go{false};
  {
    Lane lane;
    lane.post([&] {
      begun = true;
      while (!go) std::this_thread::yield();
    });
    while (!begun) std::this_thread::yield();
    for (const char name : {'a', 'b', 'c'}) {
      lane.post_latest([&done, name] { done += name; },
                       [&done, name] { done += static_cast<char>(name - 'a' + 'A'); });
    }
    go = true;
    std::atomic<bool> last{false};
    lane.post([&] { last = true; });
    while (!last) std::this_thread::yield();
  }
  EXPECT_EQ(done, "ABc");
}

}  // namespace
}  // namespace workbench::serve
