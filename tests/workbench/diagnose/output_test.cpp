// JSON, text, the better model's file and the progress line, from diagnoses made by hand.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "config/schema/document.h"
#include "plant_sim/formula/curve_effect.h"
#include "tests/workbench/diagnose/example_outcome.h"
#include "workbench/diagnose/diagnosis_report.h"
#include "workbench/diagnose/progress_line.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

TEST(DiagnosisJson, HasThePublishedKeysInSi) {
  ExampleReport outcome;
  outcome.diagnosis.ambiguous = {{"friction", "backlash"}};
  outcome.diagnosis.where = {{"force", "speed", 0.62, {"lag"}}};
  const json j = json::parse(to_json(outcome));
  EXPECT_EQ(j["verdict"], "missing");
  EXPECT_EQ(j["missing"], json({"friction"}));
  EXPECT_EQ(j["ambiguous"], json::parse(R"([["friction", "backlash"]])"));
  EXPECT_EQ(j["noise_floor_m"], 2.4e-6);
  EXPECT_EQ(j["rms_before_m"], 26.3e-6);
  EXPECT_EQ(j["rms_after_m"], 2.7e-6);
  EXPECT_EQ(j["nominal_rms_m"], 1.42e-3);
  EXPECT_EQ(j["parameters"]["damping_N_s_per_m"]["value"], 1000.0 / 3.0);  // every digit
  EXPECT_EQ(j["parameters"]["friction.coulomb_N"]["std_error"], 1.9);
  EXPECT_EQ(j["parameters"]["friction.stribeck_mps"]["std_error"], nullptr);
  EXPECT_EQ(j["parameters"]["friction.stribeck_mps"]["at_bound"], true);
  EXPECT_EQ(j["candidates"][0]["effect"], "friction");
  EXPECT_EQ(j["candidates"][0]["round"], 1);
  EXPECT_EQ(j["candidates"][0]["rms_heldout_m"], 2.7e-6);
  EXPECT_EQ(j["candidates"][0]["p_value"], 1e-12);
  EXPECT_EQ(j["candidates"][2]["rms_heldout_m"], nullptr);  // never fitted
  EXPECT_EQ(j["where"][0], json::parse(R"({"class": "force", "variable": "speed",
                                           "explained_ratio": 0.62, "or_class": ["lag"]})"));
  EXPECT_EQ(j["steps"][0]["added"], nullptr);
  EXPECT_EQ(j["steps"][1]["added"], "friction");
  EXPECT_EQ(j["steps"][1]["rms_heldout_m"], 2.7e-6);
  EXPECT_EQ(j["interrupted"], false);
  for (const char* key : {"advice", "runtime_s", "notes", "same_here"})
    EXPECT_TRUE(j.contains(key));
}

TEST(DiagnosisJson, RefinedAreTheMissingOnesThatTheFileHas) {
  ExampleReport outcome;
  EXPECT_EQ(json::parse(to_json(outcome))["refined"], json::array());
  outcome.diagnosis.missing = {"backlash", "friction"};
  outcome.diagnosis.in_file = {"friction", "force_ripple"};
  EXPECT_EQ(json::parse(to_json(outcome))["refined"], json({"friction"}));
}

TEST(DiagnosisJson, MissingNumbersAreNull) {
  ExampleReport outcome;
  outcome.diagnosis = {};
  outcome.diagnosis.verdict = selection::Verdict::not_excited;
  outcome.diagnosis.noise_floor_m = std::nan("");
  const json j = json::parse(to_json(outcome));
  EXPECT_EQ(j["verdict"], "not_excited");
  for (const char* key :
       {"noise_floor_m", "rms_before_m", "rms_after_m", "nominal_rms_m", "free_run_after_m"}) {
    EXPECT_EQ(j[key], nullptr) << key;
  }
  EXPECT_TRUE(j["candidates"].empty());
}

TEST(DiagnosisJson, ACurveHasItsPoints) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.better = plant_sim::load_model(SPOOLWATCH_SOURCE_DIR "/config/models/force_driven_axis.toml");
  plant_sim::formula::FormulaEffect effect;
  effect.name = "force_over_v";
  effect.curve = {"v_mps", "", {-0.1, 0.0, 0.1}, {-5.0, 0.0, 5.0}};
  derive_formula(effect);
  d.better.declare(effect, "test");
  *d.better.value("force_over_v.f3") = 7.0;
  d.verdict = selection::Verdict::learned;
  d.laws = {{effect, {"v"}}};
  const json law = json::parse(to_json(outcome))["laws"][0];
  EXPECT_EQ(law["formula"], "f(v_mps)");
  EXPECT_EQ(law["table"], json::parse(R"({"over": "v_mps", "times": "", "x": [-0.1, 0.0, 0.1]})"));
  EXPECT_EQ(law["parameters"]["f3"]["value"], 7.0);
}

TEST(DiagnosisJson, ADifferenceBetweenRecordsNamesTheRecord) {
  ExampleReport outcome;
  outcome.diagnosis.verdict = selection::Verdict::changing;
  selection::ParameterChange change;
  change.parameter = "mass_kg";
  change.kind = selection::ChangeKind::record;
  change.record = "b.csv";
  change.at_s = std::nan("");
  change.from = 40.0;
  change.to = 50.0;
  outcome.diagnosis.changing = {change};
  const json one = json::parse(to_json(outcome))["changing"][0];
  EXPECT_EQ(one["kind"], "record");
  EXPECT_EQ(one["record"], "b.csv");
  EXPECT_EQ(one["to"], 50.0);
  EXPECT_TRUE(one["at_s"].is_null());
}

TEST(DiagnosisJson, ALawHasItsCurveAndWhatItsBlockNeeds) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.better = plant_sim::load_model(SPOOLWATCH_SOURCE_DIR "/config/models/force_driven_axis.toml");
  const plant_sim::formula::FormulaEffect effect{
      "cubic_damping", "force", "c * v_mps^3", "drag", {{"c", "size", 0.0, 1e6, 1e3, 0.0}}, "", {}};
  d.better.declare(effect, "test");
  *d.better.value("cubic_damping.c") = 800.0;
  d.verdict = selection::Verdict::learned;
  d.laws = {{effect, {"v"}}};
  d.parameters = {{"cubic_damping.c", 800.0, 4.0, false}};
  const json law = json::parse(to_json(outcome))["laws"][0];
  EXPECT_EQ(law["parameters"]["c"],
            json::parse(R"({"value": 800.0, "std_error": 4.0, "what": "size", "min": 0.0,
                            "max": 1e6, "typical": 1e3, "neutral": 0.0})"));
  const json& curve = law["curve"];
  EXPECT_EQ(curve["variable"], "v_mps");
  EXPECT_EQ(curve["quantity"], "force_N");
  ASSERT_EQ(curve["x"].size(), curve["f"].size());
  ASSERT_EQ(curve["x"].size(), curve["std_error"].size());
  const double v_mps = curve["x"][3];
  EXPECT_NEAR(curve["f"][3], 800.0 * std::pow(v_mps, 3), 1e-6);
  EXPECT_NEAR(curve["std_error"][3], 4.0 * std::abs(std::pow(v_mps, 3)), 1e-6);
}

TEST(DiagnosisText, BeginsWithTheVerdictAndEndsWithTheNextCommand) {
  ExampleReport outcome;
  outcome.input.output = "better.toml";
  std::ostringstream out;
  print(outcome, out);
  const std::string text = out.str();
  EXPECT_TRUE(text.starts_with("Missing: friction: Coulomb 145.3 +- 1.9 N")) << text;
  EXPECT_THAT(text, HasSubstr("+ friction                      2.7 um     1.12  #\n"));
  EXPECT_THAT(text, testing::ContainsRegex("friction +2.7 um  p < 1e-6   taken\n"));
  EXPECT_THAT(text, Not(HasSubstr("backlash")));  // never fitted
  EXPECT_TRUE(text.ends_with("next: spoolwatch compare better.toml bench.csv\n")) << text;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
}

TEST(DiagnosisText, CandidatesOfALaterRoundAreHeldAgainstWhatWasTaken) {
  ExampleReport outcome;
  selection::Round& round = outcome.diagnosis.search.rounds.front();
  const auto text = [&] {
    std::ostringstream out;
    print(outcome, out);
    return out.str();
  };
  EXPECT_THAT(text(), HasSubstr("candidates of round 1: 26.3 um without any\n"));
  round.before.added = {"null_bias"};
  EXPECT_THAT(text(), HasSubstr("26.3 um with null_bias alone\n"));
}

TEST(BetterModel, SaysAtItsTopWhatWasAddedAndReadsBack) {
  ExampleReport outcome;
  outcome.input.records = {"bench\r\nmass_kg = 1.csv"};  // no comment ends early
  *outcome.diagnosis.better.value("friction.coulomb_N") = 145.31;
  outcome.interrupted = true;
  const std::string text = better_model_text(outcome);
  EXPECT_THAT(text, HasSubstr("# Missing: friction: Coulomb 145.3 +- 1.9 N"));
  EXPECT_THAT(text, HasSubstr("INTERRUPTED"));
  EXPECT_THAT(text, HasSubstr("model file as it is 1.42 mm, its parameters fitted 26.3 um"));
  EXPECT_THAT(text, HasSubstr("# spoolwatch diagnose rig.toml bench.csv\n"));
  plant_sim::ModelFile read =
      plant_sim::read_model(config::schema::Document::parse(text, "better.toml"));
  EXPECT_EQ(*read.value("friction.coulomb_N"), 145.31);
  EXPECT_NE(*read.value("mass_kg"), 1.0);
}

selection::SearchProgress step(int round, const std::string& effect, int done) {
  selection::SearchProgress progress;
  progress.round = round;
  progress.effect = effect;
  progress.done = done;
  progress.of = 36;
  progress.best = "friction";
  progress.best_rms_m = 2.71e-6;
  return progress;
}

TEST(ProgressLine, IsOneLineForEachRoundWhereNoTerminalIs) {
  std::ostringstream out;
  ProgressLine line(out, false, 2.4e-6);
  line.show(step(1, "friction", 1));
  selection::SearchProgress ranked = step(1, "backlash", 2);
  ranked.expected = {"friction", "backlash", "deadband"};
  line.show(ranked);
  line.show(ranked);
  line.show(step(2, "backlash", 1));
  line.end();
  EXPECT_EQ(out.str(),
            "round 1: 36 steps, best friction 2.71 um, noise floor 2.4 um\n"
            "round 1: ranked by screening: friction, backlash, deadband\n"
            "round 2: 36 steps, best friction 2.71 um, noise floor 2.4 um\n");
}

TEST(ProgressLine, IsRenewedOnATerminalAndWipedInTheEnd) {
  std::ostringstream out;
  ProgressLine line(out, true, 2.4e-6);
  line.show(step(1, "friction", 7));
  line.end();
  EXPECT_EQ(out.str(),
            "\r\x1b[Kround 1: fitting friction, 7 of 36; best friction 2.71 um, noise floor 2.4 um"
            "\r\x1b[K");
}

}  // namespace
}  // namespace workbench::diagnose
