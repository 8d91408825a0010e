// The page shows what the commands print: the same figures, and command lines that repeat them.
#include "tests/workbench/serve/study_page.h"
#include "workbench/present/text.h"
#include "workbench/serve/model_difference.h"

namespace workbench::serve {
namespace {

using testing::HasSubstr;

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

TEST_F(StudyPage, SlidersStandInTheUnitsOfTheReports) {
  ASSERT_EQ(page.post("add", {{"effect", "deadband"}}).status, 200);
  const ordered_json parameters = page.state()["parameters"];
  const auto unit = [&](const char* name) {
    for (const ordered_json& one : parameters) {
      if (one["name"] == name) return std::pair(one["unit"].get<std::string>(), one["in_si"]);
    }
    return std::pair(std::string("none of that name"), ordered_json());
  };
  EXPECT_THAT(unit("supply_pressure_Pa"), testing::Pair("bar", 1e5));
  EXPECT_THAT(unit("damping_N_s_per_m"), testing::Pair("N·s/m", 1.0));
  EXPECT_THAT(unit("deadband.half_width_V"), testing::Pair("mV", 1e-3));
  const Answer refused =
      page.post("preview", {{"values", {{"supply_pressure_Pa", 1e12}}}, {"rows", 400}});
  EXPECT_EQ(refused.status, 422);
  EXPECT_THAT(refused.body, HasSubstr(" bar"));
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

TEST_F(StudyPage, ACandidateIsTriedOnTheModelThatWasDiagnosed) {
  ASSERT_EQ(page.post("diagnose").status, 200);
  const ordered_json all = finished()["result"];
  EXPECT_EQ(all["model"], "thesis.toml");
  EXPECT_EQ(all["record"], "multisine.csv");
  ASSERT_EQ(page.post("accept").status, 200);
  // The accepted model has both effects already.
  const ordered_json both{"null_bias", "friction"};
  ASSERT_EQ(page.post("diagnose", {{"only", both}, {"model", all["model"]}}).status, 200);
  const ordered_json tried = finished(all);
  EXPECT_EQ(tried["trial"], "thesis+null_bias+friction.toml");
  EXPECT_EQ(tried["model"], "thesis-diagnosed.toml") << "what was accepted stays until the next";
  EXPECT_EQ(tried["commands"].back(),
            "spoolwatch diagnose thesis.toml multisine.csv --only null_bias --only friction -o "
            "thesis+null_bias+friction.toml");
  EXPECT_EQ(tried["result"]["before"]["candidates"], all["candidates"])
      << "the other candidates can be tried still";
  ASSERT_EQ(page.post("undo").status, 200);
  EXPECT_EQ(page.state()["model"], "thesis-diagnosed.toml");

  ASSERT_EQ(page.post("diagnose", {{"only", both}}).status, 200);
  const ordered_json refused = finished(tried["result"])["result"];
  EXPECT_EQ(refused["kind"], "error") << "the model that is open has them";
  EXPECT_EQ(refused["before"]["candidates"], all["candidates"]);
  EXPECT_EQ(page.post("diagnose", {{"model", "../thesis.toml"}}).status, 422);
  EXPECT_EQ(page.post("diagnose", {{"model", "none.toml"}}).status, 422);
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

}  // namespace
}  // namespace workbench::serve
