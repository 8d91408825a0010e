// Records with a hidden effect from a simulator of our own that shares no code with the product
// (tests/truth): another integrator, LuGre friction, a controller in the loop, quantised, noisy,
// the plant's own values off. A few of them, short; hidden_effect_set_test.cpp has many.
#include <gmock/gmock.h>

#include "estimator/greybox/selection/diagnosis.h"
#include "tests/estimator/greybox/selection/truth_records.h"
#include "tests/workbench/diagnose/judged.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;
namespace {

using diagnose_test::kAtFloor;
using diagnose_test::said;
using testing::IsEmpty;

struct Judged {
  truth::Case of;
  selection::Diagnosis diagnosis;
};

Judged judged(const std::string& spec, std::size_t seed) {
  Judged result;
  result.of = truth::parse_case(spec, seed);
  result.diagnosis = diagnose_test::found_in(
      diagnose_test::context_with(diagnose_test::dataset_of(truth::simulate(result.of))));
  return result;
}

void expect_found(const Judged& j) {
  const selection::Diagnosis& d = j.diagnosis;
  EXPECT_EQ(d.verdict, selection::Verdict::missing) << said(d);
  EXPECT_THAT(d.missing, testing::UnorderedElementsAreArray(truth::hidden_effects(j.of.hidden)))
      << said(d);
  EXPECT_LE(d.rms_after_m, kAtFloor * d.noise_floor_m) << said(d);
  EXPECT_GE(d.rms_before_m, diagnose_test::kVisible * d.noise_floor_m) << said(d);
  EXPECT_THAT(d.where, IsEmpty());
  diagnose_test::expect_values(d, j.of);
}

void expect_value(const Judged& j, const std::string& name, double truth, double tolerance) {
  const auto& all = j.diagnosis.parameters;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& p) { return p.name == name; });
  ASSERT_NE(found, all.end()) << name;
  EXPECT_NEAR(found->value, truth, tolerance) << name;
  EXPECT_NEAR(found->value, truth, diagnose_test::kStdErrors * found->std_error) << name;
}

/// One effect alone, by a law of the generator that is in no plan.
void expect_alone(const Judged& j, const std::string& effect) {
  const selection::Diagnosis& d = j.diagnosis;
  EXPECT_EQ(d.verdict, selection::Verdict::missing) << said(d);
  EXPECT_THAT(d.missing, testing::ElementsAre(effect)) << said(d);
  EXPECT_LE(d.rms_after_m, kAtFloor * d.noise_floor_m) << said(d);
  EXPECT_GE(d.rms_before_m, diagnose_test::kVisible * d.noise_floor_m) << said(d);
}

TEST(HiddenEffect, FrictionIsNamedWithItsSize) {
  expect_found(judged("motion=fast_steps,length_s=12,friction.coulomb_N=150", 11));
}

TEST(HiddenEffect, ADeadBandIsNamedWithItsWidth) {
  expect_found(judged("motion=multisine,length_s=12,deadband.half_width_V=0.2", 12));
}

TEST(HiddenEffect, ADeadBandIsNamedWithItsRoundedCorner) {
  const Judged j =
      judged("motion=multisine,length_s=12,deadband.half_width_V=0.2,deadband.corner_V=0.03", 12);
  expect_found(j);
  expect_value(j, "deadband.corner_V", 0.03, 1e-3);
}

TEST(HiddenEffect, ADeadBandIsNamedWithTheClearanceThatOpensIt) {
  const Judged j = judged(
      "motion=multisine,length_s=12,deadband.half_width_V=0.2,deadband.clearance_V=0.06", 21);
  expect_found(j);
  expect_value(j, "deadband.clearance_V", 0.06, 2e-3);
}

// An amplifier that clips ahead of a valve is no flow that saturates behind it: under a load the
// flow of a clipped command changes.
TEST(HiddenEffect, AnAmplifierThatClipsIsNamedWithItsLimitUnderALoad) {
  expect_found(judged(
      "motion=multisine,length_s=12,drive_saturation.limit_V=1.2,load_force.force_N=500", 23));
}

// The law of four edges stands among those left out: it is in no plan.
TEST(HiddenEffect, AnUnderlapIsNamedWithItsHalfWidth) {
  const Judged j =
      judged("motion=multisine,length_s=12,left_out=open_centre,left_out.size=0.12", 17);
  expect_alone(j, "underlap");
  expect_value(j, "underlap.half_width_V", 0.12, 2e-3);
}

TEST(HiddenEffect, LeakageOfTheLapsIsNamedWithWhatHalvesIt) {
  const Judged j =
      judged("motion=multisine,length_s=12,left_out=leaking_laps,left_out.size=0.03", 22);
  expect_alone(j, "lap_leakage");
  expect_value(j, "lap_leakage.opening_V", 0.03, 1e-3);
  expect_value(j, "lap_leakage.fade_V", 0.3, 0.02);
}

TEST(HiddenEffect, ANullBiasIsNamedWithItsSignOnAMismatchedPlant) {
  expect_found(judged("motion=multisine,length_s=12,mismatched=1,null_bias.offset_V=-0.07", 13));
}

TEST(HiddenEffect, OnADisturbedRigIsNamedAndTheDisturbanceToldFromIt) {
  const Judged j = judged(
      "motion=multisine,length_s=20,quadratic_damping.coefficient_N_s2_per_m2=2e4,"
      "outside.force_N=25,outside.corner_Hz=3,outside.pulsation_Pa=1.5e5,outside.pulsation_Hz=23",
      15);
  const selection::Diagnosis& d = j.diagnosis;
  EXPECT_EQ(d.verdict, selection::Verdict::missing) << said(d);
  EXPECT_THAT(d.missing, testing::ElementsAre("quadratic_damping")) << said(d);
  ASSERT_TRUE(d.disturbance.has_value());
  EXPECT_NEAR(d.disturbance->value, 25.0, 0.25 * 25.0);
  ASSERT_EQ(d.disturbance->lines.size(), 1U);
  EXPECT_EQ(d.disturbance->lines.front().as, "pressure");
  EXPECT_NEAR(d.disturbance->lines.front().frequency_Hz, 23.0, 0.1);
  EXPECT_NEAR(d.disturbance->lines.front().amplitude, 1.5e5, 0.1 * 1.5e5);
}

TEST(HiddenEffect, NoneIsClaimedOnADisturbedHealthyRig) {
  const Judged j = judged("motion=fast_steps,length_s=20,mismatched=1,outside.force_N=40", 16);
  EXPECT_EQ(j.diagnosis.verdict, selection::Verdict::nothing_missing) << said(j.diagnosis);
}

TEST(HiddenEffect, TwoAtOnceAreBothNamed) {
  const Judged j =
      judged("motion=multisine,length_s=20,deadband.half_width_V=0.2,null_bias.offset_V=0.07", 14);
  expect_found(j);
  ASSERT_EQ(j.diagnosis.steps.size(), 3U);
  EXPECT_GT(j.diagnosis.steps[0].validation_rms_m, j.diagnosis.steps[1].validation_rms_m);
  EXPECT_GT(j.diagnosis.steps[1].validation_rms_m, j.diagnosis.steps[2].validation_rms_m);
}

TEST(HiddenEffect, NoneIsFoundOnAHealthyPlantThatTheModelDoesNotMatch) {
  const selection::Diagnosis d = judged("motion=fast_steps,length_s=12,mismatched=1", 15).diagnosis;
  EXPECT_EQ(d.verdict, selection::Verdict::nothing_missing) << said(d);
  EXPECT_THAT(d.missing, IsEmpty());
  EXPECT_LE(d.rms_after_m, kAtFloor * d.noise_floor_m);
}

}  // namespace
}  // namespace workbench::diagnose
