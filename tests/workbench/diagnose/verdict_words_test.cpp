#include "workbench/diagnose/verdict_words.h"

#include <gmock/gmock.h>

#include "tests/workbench/diagnose/example_outcome.h"
#include "workbench/diagnose/advice_words.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(VerdictWords, WhatIsSureIsSaidApartFromWhatMayBe) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.verdict = selection::Verdict::undetermined;
  d.missing = {"friction", "null_bias"};
  d.possible = {{"null_bias", selection::Doubt::within_error}};
  const std::string words = verdict_words(d);
  EXPECT_THAT(words, HasSubstr("Undetermined: missing: friction: Coulomb"));
  EXPECT_THAT(words, HasSubstr("perhaps missing too: null_bias"));
}

TEST(VerdictWords, LawsThatComeNearAreNoAnswer) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.verdict = selection::Verdict::unexplained;
  d.missing = {"pendulum"};
  d.possible = {{"pendulum", selection::Doubt::stand_in}};
  plant_sim::formula::FormulaEffect pendulum;
  pendulum.name = "pendulum";
  pendulum.what = "weight on an arm";
  pendulum.formula = "force_N * sin(y_m / arm_m)";
  d.laws = {{pendulum, {"y"}}};
  EXPECT_THAT(
      verdict_words(d),
      AllOf(HasSubstr("Unexplained: "), HasSubstr("no effect of the library explains it"),
            HasSubstr("The nearest law: weight on an arm: F = force_N * sin(y_m / arm_m).")));
}

TEST(AdviceWords, AServoIsAskedForItsSpeedAndNotForASpool) {
  const std::vector<selection::Localisation> where{{"flow", "y", 0.99}};
  const std::string words = words_for_unexplained(where, "velocity_servo");
  EXPECT_THAT(words, AllOf(HasSubstr("the speed that the drive itself measures"),
                           HasSubstr("formula of y_m"), Not(HasSubstr("spool"))));
  EXPECT_THAT(words_for_unexplained(where, "hydraulic_actuator"), HasSubstr("the spool position"));
  EXPECT_THAT(words_for_unexplained({}, "velocity_servo"), Not(HasSubstr("spool")));
}

}  // namespace
}  // namespace workbench::diagnose
