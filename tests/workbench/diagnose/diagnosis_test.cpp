// The conclusion of a diagnosis, on servos of which the answer is known.
#include "workbench/diagnose/experiment_design.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "tests/estimator/greybox/selection/servo_problem.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;
namespace {

using diagnose_test::kServoGain;
using diagnose_test::servo_context;
using diagnose_test::ServoRun;
using diagnose_test::with_offset;
using diagnose_test::with_offset_and_band;
using testing::ElementsAre;
using testing::IsEmpty;

AdvisedDiagnosis diagnosed(const selection::SearchContext& context) {
  return workbench::diagnose::diagnose(context.problem, context.options);
}

TEST(Diagnosis, NamesWhatIsMissingWithItsValueAndError) {
  const selection::SearchContext context = servo_context({.rate_mps = with_offset(0.06)});
  const selection::Diagnosis d = diagnosed(context).diagnosis;
  EXPECT_EQ(d.verdict, selection::Verdict::missing);
  EXPECT_THAT(d.missing, ElementsAre("null_bias"));
  EXPECT_THAT(d.ambiguous, IsEmpty());
  ASSERT_EQ(d.parameters.size(), 2U);
  for (const selection::ParameterValue& p : d.parameters) {
    const double truth = p.name == "null_bias.offset_V" ? 0.06 : kServoGain;
    EXPECT_NEAR(p.value, truth, 3.0 * p.std_error) << p.name;
    EXPECT_GT(p.std_error, 0.0);
    EXPECT_LT(p.std_error, 0.01 * truth) << p.name;
    EXPECT_FALSE(p.at_bound);
  }
  ASSERT_EQ(d.steps.size(), 2U);
  EXPECT_EQ(d.steps[1].added, "null_bias");
  EXPECT_EQ(d.rms_before_m, d.steps[0].validation_rms_m);
  EXPECT_LE(d.rms_after_m, 1.1 * d.noise_floor_m);
  EXPECT_THAT(d.where, IsEmpty());
  plant_sim::ModelFile better = d.better;
  EXPECT_NEAR(*better.value("null_bias.offset_V"), 0.06, 1e-3);
}

TEST(Diagnosis, DoesNotDependOnTheNumberOfThreads) {
  selection::SearchContext context = servo_context({.rate_mps = with_offset_and_band(0.06, 0.1)});
  context.options.threads = 1;
  const selection::Diagnosis one = diagnosed(context).diagnosis;
  context.options.threads = 3;
  const selection::Diagnosis three = diagnosed(context).diagnosis;
  EXPECT_EQ(one.missing, three.missing);
  EXPECT_NEAR(one.rms_after_m, three.rms_after_m, 1e-3 * one.rms_after_m);
}

TEST(Diagnosis, SaysNothingIsMissingOfAHealthyRecord) {
  const selection::Diagnosis d =
      diagnosed(servo_context({.rate_mps = [](double u_V, double, double) {
        return 0.98 * kServoGain * u_V;
      }})).diagnosis;
  EXPECT_EQ(d.verdict, selection::Verdict::nothing_missing);
  EXPECT_THAT(d.missing, IsEmpty());
  EXPECT_EQ(d.steps.size(), 1U);
  EXPECT_LT(d.rms_after_m, d.nominal_rms_m);
}

TEST(Diagnosis, EstimatesTheNoiseOfALogThatIsTooSlowToShowIt) {
  ServoRun run{.rate_mps = with_offset(0.0), .samples = 600, .sample_time_s = 0.1};
  const selection::Diagnosis healthy = diagnosed(servo_context(run)).diagnosis;
  EXPECT_TRUE(healthy.floor_assumed);
  EXPECT_EQ(healthy.verdict, selection::Verdict::nothing_missing);
  // 2 um and the rounding to 5 um
  EXPECT_NEAR(healthy.noise_floor_m, std::hypot(2e-6, 5e-6 / std::sqrt(12.0)), 0.4e-6);
  run.rate_mps = with_offset(0.06);
  const selection::Diagnosis biased = diagnosed(servo_context(run)).diagnosis;
  EXPECT_EQ(biased.verdict, selection::Verdict::missing);
  EXPECT_THAT(biased.missing, ElementsAre("null_bias"));
}

TEST(Diagnosis, SaysWhatCarriesAnErrorThatNoEffectExplains) {
  const AdvisedDiagnosis advised =
      diagnosed(servo_context({.rate_mps = [](double u_V, double, double t_s) {
        return kServoGain * u_V * (1.0 - 0.05 * std::sin(t_s));
      }}));
  const selection::Diagnosis& d = advised.diagnosis;
  EXPECT_EQ(d.verdict, selection::Verdict::unexplained);
  ASSERT_FALSE(d.where.empty());
  EXPECT_EQ(d.where[0].site, "gain");
  EXPECT_EQ(d.where[0].variable, "time");
  EXPECT_FALSE(advised.advice.empty());
}

TEST(Diagnosis, AsksForMotionWhereThereIsNone) {
  const selection::SearchContext context =
      servo_context({.rate_mps = with_offset(0.0),
                     .command_V = [](double, double) { return 0.0; },
                     .samples = 1000});
  const AdvisedDiagnosis advised = diagnosed(context);
  const selection::Diagnosis& d = advised.diagnosis;
  EXPECT_EQ(d.verdict, selection::Verdict::not_excited);
  EXPECT_THAT(d.missing, IsEmpty());
  EXPECT_EQ(d.excitation.cause, selection::Excitation::Cause::no_motion);
  EXPECT_FALSE(advised.advice.empty());
  EXPECT_EQ(d.final.theta.size(), 0);
}

TEST(Diagnosis, KeepsTheBestSoFarWhenItIsInterrupted) {
  selection::SearchContext context =
      servo_context({.rate_mps = with_offset_and_band(0.06, 0.1), .samples = 2000});
  context.options.cancel = [] { return true; };
  const selection::Diagnosis d = diagnosed(context).diagnosis;
  EXPECT_TRUE(d.search.interrupted);
  EXPECT_EQ(d.steps.size(), 1U);
  EXPECT_TRUE(std::isfinite(d.rms_after_m));
}

TEST(Verdict, HasANameOfItsOwn) {
  std::set<std::string> names;
  for (const selection::Verdict verdict :
       {selection::Verdict::nothing_missing, selection::Verdict::missing,
        selection::Verdict::undetermined, selection::Verdict::learned,
        selection::Verdict::unexplained, selection::Verdict::not_excited}) {
    names.insert(selection::to_string(verdict));
  }
  EXPECT_THAT(names, ElementsAre("learned", "missing", "not_excited", "nothing_missing",
                                 "undetermined", "unexplained"));
}

}  // namespace
}  // namespace workbench::diagnose
