// The sentences on a diagnosis, for every verdict.
#include "workbench/diagnose/words.h"
#include "workbench/diagnose/diagnosis_report.h"
#include "workbench/diagnose/record_words.h"
#include "workbench/diagnose/verdict_words.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/workbench/diagnose/example_outcome.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

TEST(Words, WhatTheRecordDoesNotShowIsNoValue) {
  ExampleReport outcome;
  for (selection::ParameterValue& p : outcome.diagnosis.parameters) {
    if (p.name != "friction.stribeck_mps") continue;
    p.at_bound = false;
    p.std_error = std::nan("");
  }
  EXPECT_EQ(verdict_words(outcome.diagnosis),
            "Missing: friction: Coulomb 145.3 +- 1.9 N, static 181 +- 4 N.");
}

TEST(Words, ErrorsDoNotContainWhatAParameterAtItsBoundIsOff) {
  ExampleReport outcome;
  const auto bounds = HasSubstr("the errors of the others do not contain");
  EXPECT_THAT(remarks(outcome), testing::Not(Contains(bounds)));
  ASSERT_EQ(outcome.diagnosis.parameters.front().name.find('.'), std::string::npos);
  outcome.diagnosis.parameters.front().at_bound = true;
  EXPECT_THAT(remarks(outcome), Contains(bounds));
  outcome.diagnosis.parameters.front().value = 0.0;
  EXPECT_THAT(remarks(outcome), testing::Not(Contains(bounds))) << "zero may be its value";
}

TEST(Words, MissingEffectIsNamedWithItsValuesAndTheirErrors) {
  const ExampleReport outcome;
  EXPECT_EQ(verdict_words(outcome.diagnosis),
            "Missing: friction: Coulomb 145.3 +- 1.9 N, static 181 +- 4 N, Stribeck speed 500 mm/s "
            "(at its bound).");
  EXPECT_THAT(remarks(outcome), Contains("The held-out error falls from 26.3 um to 2.7 um; the "
                                         "noise floor is 2.4 um."));
}

TEST(Words, APredictionShowsWhatASimulationUnderDisturbanceHides) {
  ExampleReport outcome;
  outcome.diagnosis.by_innovations = true;
  outcome.diagnosis.rms_after_m = 31e-6;
  outcome.diagnosis.prediction = selection::PredictionErrors{28.1e-6, 2.82e-6};
  EXPECT_THAT(remarks(outcome),
              Contains("The held-out error of a simulation, which holds the disturbance, goes from "
                       "26.3 um to 31 um; the noise floor is 2.4 um. One sample ahead, predictions "
                       "are off by 28.1 um without and by 2.82 um with friction."));
}

TEST(Words, APriorOfAnEffectThatWasAddedIsNoValueOfTheFile) {
  ExampleReport outcome;
  selection::ParameterValue& friction = outcome.diagnosis.parameters.back();
  ASSERT_TRUE(was_added(outcome.diagnosis, friction));
  friction.prior_sds = 3.0;
  EXPECT_THAT(remarks(outcome), Not(Contains(HasSubstr("standard deviations of its prior"))));
}

TEST(Words, ValuesFarFromTheFilesShareASentence) {
  ExampleReport outcome;
  selection::ParameterValue damping = outcome.diagnosis.parameters.front();
  ASSERT_EQ(damping.name, "damping_N_s_per_m");
  outcome.diagnosis.parameters.front().prior_sds = 3.1;
  EXPECT_THAT(remarks(outcome), Contains(HasSubstr("damping_N_s_per_m ends 3.1 standard deviations "
                                                   "of its prior above the file's value")));
  damping.name = "mass_kg";
  damping.prior_sds = -2.6;
  outcome.diagnosis.parameters.push_back(damping);
  EXPECT_THAT(remarks(outcome),
              Contains(HasSubstr("damping_N_s_per_m 3.1 above, mass_kg 2.6 below. The file")));
  EXPECT_THAT(remarks(outcome), Not(Contains(HasSubstr("standard deviations of its prior "))));
}

TEST(Words, ADataSheetValueThatTheRecordCorrectsByMuchIsStated) {
  ExampleReport outcome;
  estimator::greybox::FreeParameter damping;
  damping.name = "damping_N_s_per_m";
  damping.scale = estimator::greybox::ParameterScale::logarithmic;
  damping.unit = 1000.0;
  damping.prior_sd = 0.5;
  const auto said = [&] {
    outcome.input.problem.plant_parameters = {damping};
    return remarks(outcome);
  };
  outcome.diagnosis.parameters.front().prior_sds = -2.2;
  const auto sentence =
      Contains(std::string("damping_N_s_per_m is 333 +- 4 N s/m, where the file says 1000 N s/m."));
  EXPECT_THAT(said(), sentence);
  outcome.diagnosis.verdict = selection::Verdict::unexplained;  // it may make up for that
  EXPECT_THAT(said(), Not(sentence));
  outcome.diagnosis.verdict = selection::Verdict::missing;
  damping.unit = 350.0;  // by little
  EXPECT_THAT(said(), Not(sentence));
  damping.unit = 1000.0;
  damping.prior_sd = 2.0;  // a guess, no value of a data sheet
  EXPECT_THAT(said(), Not(sentence));
}

TEST(Words, NothingMissingIsSaidBesideTheNoiseFloor) {
  ExampleReport outcome;
  outcome.diagnosis.verdict = selection::Verdict::nothing_missing;
  outcome.diagnosis.missing.clear();
  EXPECT_THAT(verdict_words(outcome.diagnosis),
              HasSubstr("Nothing is missing: the model, its own parameters adjusted, is left with "
                        "2.7 um on held-out data, 1.12 times the noise floor of 2.4 um"));
  EXPECT_THAT(remarks(outcome), Contains("With the plant's own parameters fitted, the held-out "
                                         "error goes from 1.42 mm to 26.3 um."));
}

TEST(Words, AnEffectThatWasRefusedMayLowerTheError) {
  ExampleReport outcome;
  outcome.diagnosis.verdict = selection::Verdict::nothing_missing;
  outcome.diagnosis.missing.clear();
  outcome.diagnosis.search.refused = {{{"friction"}, 2.5e-6, selection::Refusal::unlikely}};
  EXPECT_THAT(verdict_words(outcome.diagnosis),
              testing::Not(HasSubstr("no effect of the library lowers it")));
  EXPECT_THAT(remarks(outcome),
              Contains(AllOf(HasSubstr("Not taken: friction"), HasSubstr("next sample better"))));
  outcome.diagnosis.in_file = {"friction"};
  EXPECT_THAT(remarks(outcome),
              Contains(HasSubstr("Not taken: friction beyond the model's own, which")));
  outcome.diagnosis.in_file.clear();
  outcome.diagnosis.disturbance = selection::Disturbance{};
  EXPECT_THAT(remarks(outcome), Contains(HasSubstr("a disturbance explains the samples better")));
  outcome.diagnosis.disturbance.reset();
  outcome.diagnosis.search.refused.clear();
  EXPECT_THAT(verdict_words(outcome.diagnosis), HasSubstr("no effect of the library lowers it"));
}

/// Friction beside one of two rivals.
void set_rivals(selection::Diagnosis& d) {
  d.verdict = selection::Verdict::undetermined;
  d.missing = {"friction", "flow_asymmetry"};
  d.ambiguous = {{"flow_asymmetry", "load_force"}};
}

TEST(Words, RivalsAreNamedWithWhatIsSureInAnyCase) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  set_rivals(d);
  outcome.advice = "Move faster.";
  const std::string words = verdict_words(d);
  EXPECT_THAT(words, HasSubstr("Undetermined: flow_asymmetry or load_force is missing"));
  EXPECT_THAT(words, HasSubstr("Missing in any case: friction: Coulomb"));
  EXPECT_THAT(remarks(outcome), Contains("Move faster."));
}

TEST(Words, WhatMayBeMissingIsNotClaimed) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.verdict = selection::Verdict::undetermined;
  d.possible = {{"friction", selection::Doubt::within_error}};
  EXPECT_THAT(verdict_words(d), HasSubstr("Undetermined: perhaps missing: friction: Coulomb"));
  EXPECT_THAT(remarks(outcome),
              Contains("Not established: friction (its size is within its error)."));
}

TEST(Words, WhatIsNotEstablishedIsNotMissingInAnyCase) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  set_rivals(d);
  d.possible = {{"friction", selection::Doubt::within_error}};
  EXPECT_THAT(verdict_words(d), testing::Not(HasSubstr("in any case")));
  d.verdict = selection::Verdict::changing;
  d.changing.resize(1);
  d.changing.front().parameter = "mass_kg";
  EXPECT_THAT(verdict_words(d), HasSubstr("Changing: flow_asymmetry is missing, and mass_kg"));
  d.possible.push_back({"flow_asymmetry", selection::Doubt::at_bound});
  EXPECT_THAT(verdict_words(d),
              HasSubstr("Changing: friction and flow_asymmetry may be missing, and mass_kg"));
}

TEST(Words, UnexplainedErrorSaysWhereItEnters) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.verdict = selection::Verdict::unexplained;
  d.rms_after_m = 12e-6;
  d.where = {{"force", "speed", 0.62}, {"flow", "v", 0.4}};
  EXPECT_THAT(verdict_words(d), HasSubstr("Incomplete: friction is missing, but an error of"));
  EXPECT_THAT(remarks(outcome),
              Contains(HasSubstr("Used in the better model: friction: Coulomb 145.3 +- 1.9 N")));
  EXPECT_THAT(verdict_words(d), HasSubstr("12 um on held-out data, 5.00 times the noise floor"));
  EXPECT_THAT(
      remarks(outcome),
      Contains("The remaining error enters as a force that goes with the speed (62 % of its "
               "square), or as a flow that goes with the velocity v (40 %)."));
  d.missing.clear();
  EXPECT_THAT(verdict_words(d), HasSubstr("Unexplained: an error of 12 um"));
}

TEST(Words, NameNoPlaceWhereOthersExplainAboutAsMuch) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.verdict = selection::Verdict::unexplained;
  d.missing.clear();
  d.where = {{"measurement", "y", 0.83, {"gain", "force"}}, {"measurement", "acceleration", 0.06}};
  EXPECT_THAT(remarks(outcome),
              Contains("The remaining error goes with the position y (83 % of its square), or with "
                       "the acceleration (6 %); the record cannot tell whether it enters as an "
                       "error of the measurement, as a change of the gain or as a force."));
  d.where = {{"measurement", "speed", 0.79, {"lag"}}};
  EXPECT_THAT(remarks(outcome),
              Contains("The remaining error goes with the speed (79 % of its square); the record "
                       "cannot tell whether it enters as an error of the measurement or as a lag "
                       "between command and reading."));
}

TEST(Words, LeaveThePlaceOfAChangeToTheChange) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.verdict = selection::Verdict::changing;
  d.missing.clear();
  d.changing = {{.parameter = "damping_N_s_per_m", .at_s = 12.0, .from = 300.0, .to = 150.0}};
  d.where_is_whole = true;
  d.where = {{"force", "time", 0.97, {"flow"}}};
  EXPECT_THAT(remarks(outcome),
              Contains("The error of the model without change goes with the time (97 % of its "
                       "square)."));
}

TEST(Words, ScatterBetweenRepetitionsIsTheFloorWhereItIsLarger) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.verdict = selection::Verdict::unexplained;
  d.missing.clear();
  d.rms_after_m = 12e-6;
  d.repetition = {5.0, 6e-6, 10.4e-6};
  EXPECT_THAT(verdict_words(d), HasSubstr("2.00 times the scatter between repetitions of the "
                                          "motion, 6 um, remains"));
  std::vector<StepWords> floors = floor_steps(d);
  ASSERT_EQ(floors.size(), 2U);
  EXPECT_EQ(floors[0].what, "between repetitions");
  EXPECT_EQ(floors[0].rms_m, 6e-6);
  EXPECT_EQ(floors[1].what, "noise floor");
  d.repetition->scatter_m = 2e-6;  // sensor noise alone is larger
  EXPECT_THAT(verdict_words(d), HasSubstr("5.00 times the noise floor of 2.4 um"));
  EXPECT_EQ(floor_steps(d).size(), 1U);
}

TEST(Words, EffectsUnderOneDoubtShareASentence) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.possible = {{"friction", selection::Doubt::within_error},
                {"backlash", selection::Doubt::rivals},
                {"deadband", selection::Doubt::within_error}};
  EXPECT_THAT(remarks(outcome),
              Contains("Not established: friction and deadband (the size "
                       "of each is within its error); backlash (others do as well)."));
}

TEST(Words, AliasesOfWhatIsNotEstablishedAreLeftOut) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.verdict = selection::Verdict::unexplained;
  d.same_here = {{"friction", "backlash"}};
  EXPECT_THAT(remarks(outcome), Contains(HasSubstr("The name friction is a choice")));
  d.possible = {{"friction", selection::Doubt::stand_in}};
  EXPECT_THAT(remarks(outcome), testing::Not(Contains(HasSubstr("is a choice"))));
}

TEST(Words, RecordWithoutMotionGivesItsReasonAndNoFigures) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d = {};
  d.verdict = selection::Verdict::not_excited;
  d.excitation = {selection::Excitation::Cause::no_motion, 1e-5, 1e-6};
  outcome.advice = "Move more.";
  EXPECT_EQ(verdict_words(d),
            "The record cannot tell: the rod moves by 0.01 mm in all, 0.001 mm of it noise.");
  EXPECT_THAT(remarks(outcome), testing::ElementsAre("Move more."));
  EXPECT_EQ(next_command(outcome), "");
}

TEST(Words, NotesNameTheRecordTheGapsAndTheInterruption) {
  ExampleReport outcome;
  greybox::Dataset record;
  record.name = "servo";
  record.notes = {"a gap at 3 s"};
  record.gaps = {1, 2, 99};
  outcome.input.problem.data.records = {record};
  outcome.diagnosis.search.interrupted = true;
  EXPECT_THAT(notes(outcome),
              testing::ElementsAre("servo: a gap at 3 s",
                                   "servo: 1 gap: the simulation restarts in each of 2 segments",
                                   "servo: 99 samples in segments shorter than 1 s are left out",
                                   "interrupted: the best so far"));
}

TEST(Words, InterruptionIsSaidFirst) {
  ExampleReport outcome;
  outcome.interrupted = true;
  EXPECT_THAT(remarks(outcome).front(), HasSubstr("Interrupted: this is the best so far"));
  outcome.out_of_time = true;
  outcome.input.within_s = 2.5;
  EXPECT_THAT(remarks(outcome).front(), HasSubstr("Out of time after the 2.5 s of --within: this"));
}

TEST(Words, NextCommandHoldsTheBetterModelAgainstTheRecord) {
  ExampleReport outcome;
  EXPECT_EQ(next_command(outcome), "spoolwatch diagnose rig.toml bench.csv -o better.toml");
  outcome.input.output = "my rig.toml";
  EXPECT_EQ(next_command(outcome), "spoolwatch compare 'my rig.toml' bench.csv");
  outcome.input.holdouts = {"other.csv"};
  EXPECT_EQ(next_command(outcome), "spoolwatch compare 'my rig.toml' other.csv");
  outcome.input.reading.map = "u=cmd[V]";
  outcome.input.ignored = {"3:4"};
  EXPECT_EQ(next_command(outcome),
            "spoolwatch compare 'my rig.toml' other.csv --map 'u=cmd[V]' --ignore 3:4");
  outcome.input.reading.flip_command = true;
  EXPECT_EQ(next_command(outcome),
            "spoolwatch compare 'my rig.toml' other.csv --map 'u=cmd[V]' --flip --ignore 3:4");
}

TEST(Words, NextCommandTakesTheCommandAsMuchEarlierAsTheBetterModelDoes) {
  ExampleReport outcome;
  outcome.input.output = "better.toml";
  outcome.input.problem.data.sample_time_s = 0.01;
  outcome.diagnosis.command_lead_samples = 0.25;
  EXPECT_EQ(next_command(outcome), "spoolwatch compare better.toml bench.csv --advance 0.0025");
  EXPECT_THAT(better_model_text(outcome), HasSubstr("--advance 0.0025."));
  outcome.input.reading.advance_command_s = 0.02;
  EXPECT_EQ(next_command(outcome), "spoolwatch compare better.toml bench.csv --advance 0.0225");
}

TEST(Words, CommandsThatTheLogLeavesOutAreNoDisturbanceOfTheRig) {
  ExampleReport outcome;
  outcome.diagnosis.disturbance = selection::Disturbance{};
  const auto said = HasSubstr("it need not be a disturbance of the rig");
  EXPECT_THAT(remarks(outcome), Not(Contains(said)));
  outcome.diagnosis.command_lead_samples = 1.0;
  EXPECT_THAT(remarks(outcome), Not(Contains(said))) << "two clocks; none is left out";
  outcome.diagnosis.command_lead_samples = 0.25;
  EXPECT_THAT(remarks(outcome), Contains(said));
}

TEST(Words, NextCommandTurnsATurnedSign) {
  ExampleReport outcome;
  outcome.diagnosis.checks.emplace();
  outcome.diagnosis.checks->turned_sign_ratio = 100.0;
  EXPECT_EQ(next_command(outcome), "spoolwatch diagnose rig.toml bench.csv --flip -o better.toml");
  outcome.input.command += " --flip";
  EXPECT_EQ(next_command(outcome), "spoolwatch diagnose rig.toml bench.csv -o better.toml");
}

TEST(Words, NextCommandTakesAFinerStepWhereTheStepIsCoarse) {
  ExampleReport outcome;
  outcome.diagnosis.better.step_s = 0.001;
  outcome.diagnosis.noise_floor_m = 1e-6;
  outcome.diagnosis.step_error_m = 1e-5;
  EXPECT_EQ(next_command(outcome),
            "spoolwatch diagnose rig.toml bench.csv --set step_s=0.00025 -o better.toml");
  outcome.input.command = "spoolwatch diagnose rig.toml --set step_s=0.001 bench.csv";
  EXPECT_EQ(next_command(outcome),
            "spoolwatch diagnose rig.toml --set step_s=0.00025 bench.csv -o better.toml");
}

TEST(Words, EffectsThatActAlikeOnThisPlantAreNamed) {
  ExampleReport outcome;
  outcome.diagnosis.same_here = {{"friction", "my_formula"}};
  ASSERT_EQ(outcome.diagnosis.verdict, selection::Verdict::missing);
  EXPECT_THAT(verdict_words(outcome.diagnosis), HasSubstr(" (or my_formula in its place)."));
  EXPECT_THAT(remarks(outcome), testing::Not(Contains(HasSubstr("is a choice"))));
  outcome.diagnosis.verdict = selection::Verdict::unexplained;
  EXPECT_THAT(remarks(outcome), Contains("The name friction is a choice: no motion that was tried "
                                         "tells it from my_formula on this plant."));
}

}  // namespace
}  // namespace workbench::diagnose
