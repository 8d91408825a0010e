#include "workbench/diagnose/verdict_words.h"

#include <gmock/gmock.h>

#include "tests/workbench/diagnose/example_outcome.h"
#include "workbench/diagnose/advice_words.h"
#include "workbench/diagnose/effect_words.h"
#include "workbench/diagnose/words.h"

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

TEST(VerdictWords, AMisreadRecordIsOneWhenTimeIsUpToo) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.verdict = selection::Verdict::unexplained;
  d.search.interrupted = true;
  EXPECT_THAT(verdict_words(d), HasSubstr("Not decided"));
  d.checks.emplace().wrong_scale = true;
  ASSERT_TRUE(d.checks->misread());
  EXPECT_THAT(verdict_words(d), HasSubstr("read the record as it says below first"));
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

TEST(VerdictWords, AnEffectBesideALearnedLawIsMissing) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.verdict = selection::Verdict::learned;
  d.possible.clear();
  plant_sim::formula::FormulaEffect drag;
  drag.name = "drag";
  drag.what = "drag of the guide";
  d.laws = {{drag, {"v"}}};
  d.missing = {"drag"};
  EXPECT_THAT(
      verdict_words(d),
      HasSubstr("Learned: no effect of the library explains the record, but drag of the guide"));
  d.missing = {"deadband", "drag"};
  EXPECT_THAT(verdict_words(d),
              HasSubstr("Learned: deadband is missing, and beside it no effect of the library "
                        "explains the record, but drag of the guide"));
}

TEST(EffectWords, ACurveIsItsRange) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  plant_sim::formula::FormulaEffect curve;
  curve.name = "force_over_y";
  curve.curve.emplace();
  d.laws = {{curve, {"y"}}};
  d.parameters.clear();
  for (const double value : {-72.0, 3.0, 47.5}) {
    selection::ParameterValue p;
    p.name = "force_over_y.f" + std::to_string(d.parameters.size() + 1);
    p.value = value;
    d.parameters.push_back(p);
  }
  EXPECT_EQ(effect_words(d, "force_over_y"), "force_over_y: 3 values from -72 to 47.5");
}

TEST(EffectWords, OfALagOfSecondOrderSayWhatAValveIsDescribedBy) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.better = plant_sim::load_model(SPOOLWATCH_SOURCE_DIR "/config/models/velocity_servo.toml");
  *d.better.value("time_constant_s") = 0.02;
  *d.better.value("second_order_lag.inertia_ratio") = 1.0;
  d.parameters = {{"second_order_lag.inertia_ratio", 1.0, 0.01, false}};
  // 1 / (2 pi 0.02 s)
  EXPECT_EQ(effect_words(d, "second_order_lag"),
            "second_order_lag: inertia 100.0 +- 1.0 % (natural frequency 7.96 Hz, damping ratio "
            "0.5)");
}

TEST(EffectWords, OfAnEffectThatTheModelHasAreWhatItLacks) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.parameters = {{"friction.coulomb_N", 20.0, 0.1, false},
                  {"friction.static_N", 30.0, 0.1, false}};
  d.parameters.front().in_model = true;
  d.in_file = {"friction"};
  EXPECT_EQ(effect_words(d, "friction"), "friction beyond the model's own: static 30.00 +- 0.10 N");
  d.missing = {"friction"};
  EXPECT_FALSE(was_added(d, d.parameters.front())) << "it was 20 N in the file";
  EXPECT_TRUE(was_added(d, d.parameters.back()));
  // with --fix friction.coulomb_N it is no parameter of the fit
  d.parameters.erase(d.parameters.begin());
  EXPECT_EQ(effect_words(d, "friction"), "friction beyond the model's own: static 30.00 +- 0.10 N");
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
