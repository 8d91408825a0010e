// The page shows what the commands print: the same figures, and command lines that repeat them.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <functional>
#include <semaphore>

#include "config/schema/error.h"
#include "config/units/quantity.h"
#include "tests/workbench/run_command.h"
#include "tests/workbench/serve/loopback.h"
#include "workbench/present/text.h"
#include "workbench/serve/jobs.h"
#include "workbench/serve/lane.h"
#include "workbench/serve/model_difference.h"
#include "workbench/serve/study.h"

namespace workbench::serve {
namespace {

using nlohmann::ordered_json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

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

/// y' = gain (u + offset) of a shaft, sampled at 100 Hz with a reading error of some 10 urad.
std::string turning_record(double gain_radps_per_V, double offset_V) {
  constexpr double kStep_s = 0.01;
  std::string text = "t_s,u_V,y_rad\n";
  double y_rad = 1.0;
  std::uint32_t noise = 7;
  for (int k = 0; k < 2000; ++k) {
    const double t_s = kStep_s * k;
    const double u_V = std::sin(3.0 * t_s) + 0.5 * std::sin(7.3 * t_s + 1.0) - offset_V;
    noise = noise * 1664525U + 1013904223U;
    const double error_rad = 2e-5 * (static_cast<double>(noise >> 8U) / (1U << 24U) - 0.5);
    text += fmt::format("{:.2f},{:.9f},{:.9f}\n", t_s, u_V, y_rad + error_rad);
    y_rad += kStep_s * gain_radps_per_V * (u_V + offset_V);
  }
  return text;
}

constexpr const char* kTurningModel = R"(schema_version = 1
name = "turning"
plant = "velocity_servo"
motion = "rotary"
[parameters]
gain_mps_per_V = 0.3
time_constant_s = 0
)";

TEST_F(StudyPage, AJobPrintsItsOwnModelsUnitsWhileAnotherModelIsOpened) {
  page.put("turning.csv", turning_record(0.31, 0.05));
  page.put("turning.toml", kTurningModel);
  std::filesystem::remove(page.session / "session.json");
  const SessionFolder folder(page.session);
  Study study(folder);
  study.open_record("turning.csv");
  study.open_model("turning.toml");
  EXPECT_THAT(study.state()["shown"].dump(), AllOf(HasSubstr("mrad"), Not(HasSubstr(" mm"))));

  std::binary_semaphore begun(0);
  std::binary_semaphore opened(0);
  std::binary_semaphore ended(0);
  std::vector<std::string> progress;
  JobResult result;
  Jobs jobs;
  ASSERT_TRUE(jobs.diagnose(
      study.diagnosis_request({}),
      [&](const std::string& text, int, int) {
        progress.push_back(text);
        if (progress.size() > 2) return;
        begun.release();
        opened.acquire();
      },
      [&](JobResult done) {
        result = std::move(done);
        ended.release();
      }));
  begun.acquire();
  study.open_model("thesis.toml");
  const ordered_json shown = study.state()["shown"];
  EXPECT_THAT(shown["verdict"].get<std::string>(), HasSubstr("rod"));
  EXPECT_THAT(shown["figures"].dump(), AllOf(HasSubstr(" mm"), Not(HasSubstr("rad"))));
  EXPECT_THAT(study.curves({}), HasSubstr("\"unit\":\"mm\""));
  opened.release();
  begun.acquire();
  EXPECT_THAT(study.curves({}), HasSubstr("\"unit\":\"mm\"")) << "the job has printed angles";
  EXPECT_EQ(config::units::moving_part(), "rod");
  opened.release();
  ended.acquire();
  EXPECT_THAT(result.summary["words"].get<std::string>(), HasSubstr("null_bias"));
  EXPECT_THAT(progress.back(), HasSubstr("rad"));
  const std::string summary = result.summary.dump();
  EXPECT_THAT(summary, HasSubstr("rad"));
  for (const char* const unit : {" mm", " µm", " m\"", " N"}) {
    EXPECT_THAT(summary, Not(HasSubstr(unit)));
  }
}

TEST_F(StudyPage, AModelThatCannotBeOpenedLeavesTheUnits) {
  page.put("turning.toml", kTurningModel);
  page.put(
      "standing.csv", "t_s,u_V,y_rad\n" + [] {
        std::string rows;
        for (int k = 0; k < 500; ++k) rows += fmt::format("{:.2f},1,0.5\n", 0.01 * k);
        return rows;
      }());
  std::filesystem::remove(page.session / "session.json");
  const SessionFolder folder(page.session);
  Study study(folder);
  study.open_record("standing.csv");
  EXPECT_THROW(study.open_model("turning.toml"), config::schema::Error);
  EXPECT_EQ(config::units::moving_part(), "rod");
}

TEST_F(StudyPage, LawsAreThoseOfTheModelAndOfTheOneBefore) {
  const auto laws = [&] { return ordered_json::parse(page.post("laws").body)["laws"]; };
  const ordered_json alone = laws();
  ASSERT_EQ(alone.size(), 2U);
  EXPECT_EQ(alone[0]["x"], "command, V");
  EXPECT_TRUE(alone[0]["before"].is_null());
  EXPECT_GT(alone[0]["samples"]["x"].size(), 500U);
  EXPECT_EQ(alone[1]["y"], "force, N");
  EXPECT_TRUE(alone[1]["samples"]["x"].empty());
  ASSERT_EQ(page.post("add", {{"effect", "deadband"}}).status, 200);
  const ordered_json trial = laws();
  EXPECT_EQ(trial[0]["before"], alone[0]["model"]);
  EXPECT_NE(trial[0]["model"]["y"], alone[0]["model"]["y"]);
  ServedFolder empty({}, "served_empty");
  empty.log_in();
  EXPECT_EQ(empty.post("laws").status, 422);
}

TEST_F(StudyPage, TwoModelsStandSideBySideWithWhatDiffers) {
  ASSERT_EQ(page.post("add", {{"effect", "null_bias"}}).status, 200);
  ASSERT_EQ(page.post("accept").status, 200);
  EXPECT_TRUE(page.state()["beside"].is_null());
  ASSERT_EQ(page.post("beside", {{"name", "thesis.toml"}}).status, 200);
  const ordered_json beside = page.state()["beside"];
  EXPECT_EQ(beside["model"], "thesis.toml");
  EXPECT_EQ(beside["shown"], "thesis+null_bias.toml");
  EXPECT_EQ(beside["figures"]["there"][0], "1.92 mm");
  ASSERT_EQ(beside["differences"].size(), 1U);
  EXPECT_EQ(beside["differences"][0]["name"], "null_bias.offset_V");
  EXPECT_EQ(beside["differences"][0]["there"], "-");
  const ordered_json curves = ordered_json::parse(page.post("curves", {{"rows", 400}}).body);
  EXPECT_EQ(curves["ghost_model"].size(), curves["t"].size());
  EXPECT_EQ(page.post("beside", {{"name", "thesis+null_bias.toml"}}).status, 422);
  EXPECT_EQ(page.post("beside", {{"name", "none.toml"}}).status, 422);
  EXPECT_EQ(page.state()["beside"]["model"], "thesis.toml");

  // It stays while the record changes, and goes with its file.
  std::filesystem::copy(kTour / "steps.csv", page.session);
  ASSERT_EQ(page.post("record", {{"name", "steps.csv"}}).status, 200);
  EXPECT_EQ(page.state()["beside"]["model"], "thesis.toml");
  std::filesystem::remove(page.session / "thesis.toml");
  ASSERT_EQ(page.post("record", {{"name", "multisine.csv"}}).status, 200);
  EXPECT_TRUE(page.state()["beside"].is_null());
}

TEST_F(StudyPage, ModelsThatDifferTooLittleForThreeDigitsAreToldApart) {
  plant_sim::ModelFile here = plant_sim::load_model(path("thesis.toml"));
  plant_sim::ModelFile there = here;
  EXPECT_TRUE(differences(here, there).empty());
  *there.value("mass_kg") *= 1.0 + 1e-6;
  const std::vector<ModelDifference> found = differences(here, there);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].name, "mass_kg");
  EXPECT_NE(found[0].here, found[0].there);
}

TEST_F(StudyPage, ModelsFittedAgainAreNumbered) {
  for (const char* const expected :
       {"thesis-fitted.toml", "thesis-fitted-2.toml", "thesis-fitted-3.toml"}) {
    ASSERT_EQ(page.post("fit").status, 200);
    EXPECT_EQ(finished()["trial"], expected);
    ASSERT_EQ(page.post("accept").status, 200);
  }
  ASSERT_EQ(page.post("add", {{"effect", "null_bias"}}).status, 200);
  EXPECT_EQ(page.state()["trial"], "thesis+null_bias.toml");
}

TEST_F(StudyPage, ATriggerIsCheckedAndNothingIsSavedBeforeACapture) {
  const ordered_json good{{"mode", "single"}, {"channel", "u"},      {"edge", "either"},
                          {"level", 1.5},     {"before_ratio", 0.5}, {"window_s", 1.0},
                          {"hold_off_s", 2}};
  EXPECT_EQ(page.post("trigger", good).status, 200);
  for (const ordered_json& wrong : std::vector<ordered_json>{{{"mode", "often"}},
                                                             {{"channel", "time"}},
                                                             {{"edge", ""}},
                                                             {{"level", "high"}},
                                                             {{"level", 1e300}},
                                                             {{"window_s", 0}},
                                                             {{"window_s", 1e6}},
                                                             {{"before_ratio", -0.1}},
                                                             {{"before_ratio", 1.1}},
                                                             {{"hold_off_s", -1}}}) {
    ordered_json body = good;
    body.update(wrong);
    EXPECT_EQ(page.post("trigger", body).status, 422) << wrong;
  }
  EXPECT_EQ(page.post("trigger").status, 422);
  const Answer none = page.post("capture");
  EXPECT_EQ(none.status, 422);
  EXPECT_THAT(none.body, HasSubstr("nothing has been captured"));
}

TEST(SessionFolder, DerivedNamesDoNotGrow) {
  EXPECT_EQ(derived_name("rig.toml", "-fitted"), "rig-fitted.toml");
  EXPECT_EQ(derived_name("rig-fitted.toml", "-fitted"), "rig-fitted.toml");
  EXPECT_EQ(derived_name("rig-fitted-12.toml", "-diagnosed"), "rig-diagnosed.toml");
  EXPECT_EQ(derived_name("rig-diagnosed.toml", "+friction"), "rig+friction.toml");
  EXPECT_EQ(derived_name("rig-2.toml", "-fitted"), "rig-2-fitted.toml");
  EXPECT_EQ(derived_name("well-fitted-rig.toml", "-fitted"), "well-fitted-rig-fitted.toml");
}

TEST_F(StudyPage, ANameTooLongIsCutBetweenCharacters) {
  const SessionFolder folder(page.session);
  std::string name;
  for (int i = 0; i < 45; ++i) name += "ä";  // 90 bytes
  name += "-fitted.toml";
  const std::string first = folder.fresh_name(name);
  EXPECT_TRUE(is_plain_name(first)) << first;
  EXPECT_THAT(first, testing::EndsWith(".toml"));
  page.put(first, "");
  const std::string second = folder.fresh_name(name);
  EXPECT_TRUE(is_plain_name(second)) << second;
  EXPECT_THAT(second, testing::EndsWith("-2.toml"));
}

TEST_F(StudyPage, AModelWithTheLongestNameIsFitted) {
  const std::string longest = std::string(95, 'm') + ".toml";
  std::filesystem::copy_file(page.session / "thesis.toml", page.session / longest);
  ASSERT_EQ(page.post("model", {{"name", longest}}).status, 200);
  ASSERT_EQ(page.post("fit").status, 200);
  const ordered_json fitted = finished();
  EXPECT_NE(fitted["trial"], "") << fitted["result"];
  EXPECT_EQ(fitted["trial"].get<std::string>().size(), 100U);
}

TEST_F(StudyPage, ARefusedChangeLeavesSessionAndFolder) {
  const SessionFolder folder(page.session);
  Study study(folder);
  study.ignore({"3:5"});
  const std::string shown = study.state().dump();
  const std::string files = page.everything();
  EXPECT_THROW(study.take_trial("none.toml", "thesis.toml", "fitted", "spoolwatch fit"),
               config::schema::Error);
  EXPECT_EQ(study.state().dump(), shown);
  EXPECT_EQ(page.everything(), files);

  // Nothing can be saved.
  std::filesystem::remove(page.session / "session.json");
  std::filesystem::create_directory(page.session / "session.json");
  std::filesystem::create_directory(page.session / "session.json" / "full");
  const std::string unsaved = study.state().dump();
  const std::string before = page.everything();
  for (const auto& change : std::vector<std::function<void()>>{
           [&] { study.add_effect("friction"); },
           [&] { study.open_shipped("velocity_servo.toml"); }, [&] { (void)study.write_report(); },
           [&] { study.ignore({}); }, [&] { study.open_record("multisine.csv"); }}) {
    EXPECT_THROW(change(), std::exception);
    EXPECT_EQ(study.state().dump(), unsaved);
    EXPECT_EQ(page.everything(), before);
  }
}

TEST_F(StudyPage, FilesThatAreGoneLeaveTheStateReadable) {
  std::filesystem::remove(page.session / "multisine.csv");
  std::filesystem::remove(page.session / "thesis.toml");
  const ordered_json state = page.state();
  EXPECT_EQ(state["model"], "thesis.toml");
  EXPECT_FALSE(state["parameters"].empty());
  EXPECT_EQ(page.post("fit").status, 422);
}

TEST(Jobs, AnExceptionBehindAJobEndsNothing) {
  Jobs jobs;
  std::binary_semaphore ended(0);
  const auto fails = [&](JobResult result) {
    EXPECT_NE(result.error, "");
    ended.release();
    throw std::runtime_error("behind the job");
  };
  for (int i = 0; i < 2; ++i) {
    while (jobs.running()) std::this_thread::yield();
    fit::FitRequest request;
    request.model = "none.toml";
    request.records = {"none.csv"};
    ASSERT_TRUE(jobs.fit(std::move(request), {}, fails));
    ended.acquire();
  }
}

TEST(Lane, AnExceptionEndsItsOwnWorkAlone) {
  std::binary_semaphore done(0);
  Lane lane;
  lane.post([] { throw std::runtime_error("one thing has failed"); });
  lane.post([] { throw 3; });
  lane.post([&] { done.release(); });
  EXPECT_TRUE(done.try_acquire_for(std::chrono::seconds(10)));
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
