// A parameter that changes within the record is found with its time, its kind and its values.
#include "estimator/greybox/selection/change_search.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "estimator/greybox/selection/change_scores.h"
#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/first_stage.h"
#include "tests/estimator/greybox/selection/servo_problem.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::Command;
using diagnose_test::context_of;
using diagnose_test::kServoGain;
using diagnose_test::servo_context;
using diagnose_test::with_offset;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

/// y' = 0.05 m (u + o), m and o courses of the time.
template <class Gain, class Offset>
SearchContext changing_servo(const Gain& gain, const Offset& offset_V) {
  return servo_context({.rate_mps = [=](double u_V, double, double t_s) {
    return kServoGain * gain(t_s) * (u_V + offset_V(t_s));
  }});
}

double constant(double /*t_s*/) { return 1.0; }
double nothing(double /*t_s*/) { return 0.0; }

TEST(Changes, AGainThatStepsIsDatedToASample) {
  const SearchContext context =
      changing_servo([](double t_s) { return t_s < 12.3456 ? 1.0 : 1.03; }, nothing);
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::changing);
  EXPECT_THAT(d.missing, IsEmpty());
  ASSERT_THAT(d.changing, SizeIs(1));
  const ParameterChange& change = d.changing.front();
  EXPECT_EQ(change.parameter, "gain_mps_per_V");
  EXPECT_EQ(change.kind, ChangeKind::step);
  EXPECT_NEAR(change.at_s, 12.3456, 0.005);
  EXPECT_NEAR(change.from, kServoGain, 3.0 * change.from_error + 1e-5);
  EXPECT_NEAR(change.to, 1.03 * kServoGain, 3.0 * change.to_error + 1e-5);
  EXPECT_LT(d.rms_after_m, 1.1 * d.noise_floor_m);
  // the better model has it
  ASSERT_THAT(d.better.changes, SizeIs(1));
  EXPECT_NEAR(d.better.changes.front().value, 1.03 * kServoGain, 1e-4);
}

TEST(Changes, AKnownGainThatStepsIsScoredAsAStep) {
  SearchContext context =
      changing_servo([](double t_s) { return t_s < 12.3 ? 1.0 : 1.25; }, nothing);
  for (FreeParameter& p : context.problem.plant_parameters) {
    if (p.name == "gain_mps_per_V") p.prior_sd = 0.002;
  }
  ModelStage first = first_stage(context);
  const InnovationStage stage = settled(context, first, {}, Settling::once, {});
  const std::vector<ChangeScore> scores = change_scores(stage);
  ASSERT_FALSE(scores.empty());
  EXPECT_EQ(scores.front().parameter.name, "gain_mps_per_V");
  EXPECT_EQ(scores.front().kind, ChangeKind::step);
  EXPECT_NEAR(scores.front().at_s, 12.3, 0.3);
  EXPECT_NEAR(scores.front().by, std::log(1.25), 0.05);
}

TEST(Changes, AGainThatDriftsIsARamp) {
  const SearchContext context =
      changing_servo([](double t_s) { return 1.0 + 0.04 * t_s / 20.0; }, nothing);
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::changing);
  ASSERT_THAT(d.changing, SizeIs(1));
  EXPECT_EQ(d.changing.front().parameter, "gain_mps_per_V");
  EXPECT_EQ(d.changing.front().kind, ChangeKind::ramp);
  EXPECT_NEAR(d.changing.front().from, kServoGain, 2e-4 * kServoGain);
  EXPECT_NEAR(d.changing.front().to, 1.04 * kServoGain, 2e-4 * kServoGain);
}

TEST(Changes, AGainThatWarmsUpIsAnExponential) {
  const SearchContext context =
      changing_servo([](double t_s) { return 1.05 - 0.05 * std::exp(-t_s / 3.0); }, nothing);
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::changing);
  ASSERT_THAT(d.changing, SizeIs(1));
  EXPECT_EQ(d.changing.front().kind, ChangeKind::exponential);
  EXPECT_NEAR(d.changing.front().duration_s, 3.0, 0.15);
  EXPECT_NEAR(d.changing.front().to, 1.05 * kServoGain, 1e-3 * kServoGain);
}

TEST(Changes, AnOffsetThatStepsLeavesASecondChangeToBeFound) {
  const SearchContext context = changing_servo([](double t_s) { return t_s < 14.0 ? 1.0 : 1.05; },
                                               [](double t_s) { return t_s < 6.0 ? 0.08 : 0.12; });
  const std::optional<ChangeSearch> found =
      search_changes(context, first_stage(context)).explaining;
  ASSERT_TRUE(found.has_value());
  ASSERT_THAT(found->changes, SizeIs(2));
  const bool offset_first = found->changes.front().parameter == "null_bias.offset_V";
  const ParameterChange& offset = found->changes[offset_first ? 0 : 1];
  const ParameterChange& gain = found->changes[offset_first ? 1 : 0];
  EXPECT_EQ(offset.parameter, "null_bias.offset_V");
  EXPECT_NEAR(offset.at_s, 6.0, 0.05);
  EXPECT_NEAR(offset.from, 0.08, 1e-3);
  EXPECT_NEAR(offset.to, 0.12, 1e-3);
  EXPECT_EQ(gain.parameter, "gain_mps_per_V");
  EXPECT_NEAR(gain.at_s, 14.0, 0.05);
  EXPECT_NEAR(gain.to / gain.from, 1.05, 1e-3);
}

// Each bends what is found of the other: alone, neither leaves nothing.
TEST(Changes, AnEffectIsNamedBesideANullThatDrifts) {
  const SearchContext context = servo_context({.rate_mps = [](double u_V, double, double t_s) {
    const double open_V = u_V - 0.1 + 0.01 * t_s;
    const double past_V = std::max(0.0, std::abs(open_V) - 0.08);
    return kServoGain * std::copysign(past_V, open_V);
  }});
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::changing);
  EXPECT_THAT(d.missing, ElementsAre("deadband"));
  ASSERT_THAT(d.changing, SizeIs(1));
  EXPECT_EQ(d.changing.front().parameter, "null_bias.offset_V");
  EXPECT_NEAR(d.changing.front().from, -0.1, 1e-3);
  EXPECT_NEAR(d.changing.front().to, 0.1, 1e-3);
  EXPECT_LT(d.rms_after_m, 1.1 * d.noise_floor_m);
}

TEST(Changes, ANullThatDriftsForAWhileIsDated) {
  const SearchContext context = changing_servo(
      constant, [](double t_s) { return 0.05 * std::clamp((t_s - 5.0) / 7.0, 0.0, 1.0); });
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::changing);
  ASSERT_THAT(d.changing, SizeIs(1));
  EXPECT_EQ(d.changing.front().parameter, "null_bias.offset_V");
  EXPECT_NEAR(d.changing.front().at_s, 5.0, 0.1);
  EXPECT_NEAR(d.changing.front().duration_s, 7.0, 0.2);
  EXPECT_NEAR(d.changing.front().to, 0.05, 5e-4);
}

TEST(Changes, ANullThatSettlesFromATimeOnIsAnExponential) {
  const SearchContext context = changing_servo(
      constant, [](double t_s) { return t_s < 6.0 ? 0.0 : 0.08 * -std::expm1((6.0 - t_s) / 2.5); });
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::changing);
  ASSERT_THAT(d.changing, SizeIs(1));
  EXPECT_EQ(d.changing.front().parameter, "null_bias.offset_V");
  EXPECT_EQ(d.changing.front().kind, ChangeKind::exponential);
  // the model's steps of 1 ms beside those of 0.1 ms
  EXPECT_TRUE(d.changing.front().is_dated);
  EXPECT_NEAR(d.changing.front().at_s, 6.0, 3.0 * d.changing.front().at_error_s + 1e-3);
  EXPECT_NEAR(d.changing.front().duration_s, 2.5, 0.02);
  EXPECT_NEAR(d.changing.front().to, 0.08, 3.0 * d.changing.front().to_error + 1e-6);
}

TEST(Changes, OfALongRecordSayHowMuchOfItWasSearched) {
  const SearchContext context = servo_context(
      {.rate_mps = [](double u_V, double, double t_s) { return kServoGain * (u_V + 4e-4 * t_s); },
       .samples = 60000});
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::changing);
  ASSERT_TRUE(d.searched_s.has_value());
  EXPECT_LT(*d.searched_s, 0.5 * 300.0);
}

TEST(Changes, AnOffsetBesideAGainThatStepsIsAnEffect) {
  const SearchContext context = changing_servo([](double t_s) { return t_s < 14.0 ? 1.0 : 1.05; },
                                               [](double) { return 0.1; });
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::changing);
  EXPECT_THAT(d.missing, ElementsAre("null_bias"));
  ASSERT_THAT(d.changing, SizeIs(1));
  EXPECT_EQ(d.changing.front().parameter, "gain_mps_per_V");
}

TEST(Changes, AreNotSoughtWhereOnlyEffectsAre) {
  SearchContext context =
      changing_servo([](double t_s) { return t_s < 12.3 ? 1.0 : 1.03; }, nothing);
  context.problem.effects_only = true;
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::unexplained);
  EXPECT_THAT(d.changing, IsEmpty());
  EXPECT_THAT(d.laws, IsEmpty());
}

TEST(Changes, AParameterThatTheFileChangesGetsNoSecondChange) {
  SearchContext context =
      changing_servo([](double t_s) { return t_s < 12.0 ? 1.0 : 1.03; }, nothing);
  // another record's change: erasing it would explain this record
  context.problem.model.changes.push_back(
      {.parameter = "gain_mps_per_V", .at_s = 5.0, .factor = 1.2});
  const std::optional<ChangeSearch> found =
      search_changes(context, first_stage(context)).explaining;
  if (!found) return;
  for (const ParameterChange& change : found->changes) {
    EXPECT_NE(change.parameter, "gain_mps_per_V");
  }
}

// Any time in the pause explains the record as well.
TEST(Changes, AStepInAPauseIsDatedToThePause) {
  const Command pausing = [hold = 0](double level, double y_m) mutable {
    ++hold;  // the command holds for 0.15 s: 12 to 15 s
    return hold > 80 && hold <= 100 ? 0.0 : diagnose_test::pulling_back(level, y_m);
  };
  const SearchContext context = servo_context(
      {.rate_mps = [](double u_V, double,
                      double t_s) { return kServoGain * (t_s < 14.2 ? 1.0 : 1.03) * u_V; },
       .command_V = pausing});
  const std::optional<ChangeSearch> found =
      search_changes(context, first_stage(context)).explaining;
  ASSERT_TRUE(found.has_value());
  ASSERT_THAT(found->changes, SizeIs(1));
  const ParameterChange& change = found->changes.front();
  EXPECT_EQ(change.parameter, "gain_mps_per_V");
  EXPECT_NEAR(change.at_s, 14.2, 3.0 * change.at_error_s);
  EXPECT_GT(change.at_error_s, 0.3);
  EXPECT_LT(change.at_error_s, 1.2);
}

TEST(Changes, ATimeSince1970IsDatedAsWell) {
  constexpr double kBegin_s = 1.7e9;
  SearchContext context =
      changing_servo([](double t_s) { return t_s < 12.3456 ? 1.0 : 1.03; }, nothing);
  for (double& t_s : context.problem.data.records.front().t_s) t_s += kBegin_s;
  const std::optional<ChangeSearch> found =
      search_changes(context, first_stage(context)).explaining;
  ASSERT_TRUE(found.has_value());
  const ParameterChange& change = found->changes.front();
  EXPECT_NEAR(change.at_s - kBegin_s, 12.3456, 0.005);
  EXPECT_LT(change.at_error_s, 0.01);
}

TEST(Changes, AHealthyRecordHasNone) {
  const SearchContext context = servo_context({.rate_mps = with_offset(0.0)});
  EXPECT_FALSE(search_changes(context, first_stage(context)).explaining.has_value());
}

TEST(Changes, SeveralRecordsHaveNoCommonTime) {
  SearchContext context = changing_servo(constant, nothing);
  std::vector<Dataset> twice{context.problem.data.records.front(),
                             context.problem.data.records.front()};
  context.problem.data = fit_dataset(twice, {});
  EXPECT_FALSE(search_changes(context, first_stage(context)).explaining.has_value());
}

// A difference quotient over a whole sample stops short of the time, and a second change makes up
// for that.
TEST(Changes, ALoadThatStepsIsDatedFromWithinItsSample) {
  const SearchContext context = diagnose_test::context_of(
      "motion=chirp,length_s=15,left_out=load_step,left_out.size=240,left_out.where=7.0036", 23);
  std::optional<ChangeSearch> found = search_changes(context, first_stage(context)).explaining;
  ASSERT_TRUE(found.has_value());
  ASSERT_THAT(found->changes, SizeIs(1));
  EXPECT_EQ(found->changes.front().parameter, "load_force.force_N");
  EXPECT_NEAR(found->changes.front().at_s, 7.0036, 0.0005);
  const std::string at = "change.load_force.force_N.at_s";
  InnovationStage early = found->innovations.final;
  FitSummary& fitted = early.model.fitted;
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const FreeParameter& p = fitted.parameters[i];
    if (p.name == at) fitted.theta[static_cast<Eigen::Index>(i)] = p.to_theta(7.0022);
  }
  const InnovationStage again = settled(found->context, early.model, early.noise, Settling::once,
                                        wide(context.options.threads));
  EXPECT_NEAR(again.model.fitted.value(at), 7.0036, 0.0002);
}

TEST(Changes, DampingThatStepsOnTheActuatorIsNamedAmongEightParameters) {
  const SearchContext context = context_of(
      "motion=multisine,length_s=30,plant.damping_N_s_per_m=1000,"
      "at14:plant.damping_N_s_per_m=1900");
  const std::optional<ChangeSearch> found =
      search_changes(context, first_stage(context)).explaining;
  ASSERT_TRUE(found.has_value());
  ASSERT_THAT(found->changes, SizeIs(1));
  const ParameterChange& change = found->changes.front();
  EXPECT_EQ(change.parameter, "damping_N_s_per_m");
  EXPECT_EQ(change.kind, ChangeKind::step);
  EXPECT_NEAR(change.at_s, 14.0, 3.0 * change.at_error_s) << change.at_error_s;
  EXPECT_NEAR(change.at_s, 14.0, 0.05);
  EXPECT_NEAR(change.to / change.from, 1.9, 0.1);
}

// A supply and a gain move the rod alike until both fits have converged.
TEST(Changes, ASupplyThatStepsIsNoGainThatDoes) {
  const SearchContext context = context_of(
      "motion=multisine,length_s=30,plant.mass_kg=52.5,plant.valve_gain_m_per_V=2.55e-5,"
      "plant.damping_N_s_per_m=950,at12:plant.supply_pressure_Pa=6e6",
      71);
  const std::optional<ChangeSearch> found =
      search_changes(context, first_stage(context)).explaining;
  ASSERT_TRUE(found.has_value());
  ASSERT_THAT(found->changes, SizeIs(1));
  const ParameterChange& change = found->changes.front();
  EXPECT_EQ(change.parameter, "supply_pressure_Pa");
  EXPECT_THAT(change.rivals, IsEmpty());
  EXPECT_NEAR(change.to / change.from, 6.0 / 6.89, 0.002);
}

// As the motion grows with the time, the drift looks like a law of the motion.
TEST(LongChanges, AGainThatDriftsDuringAChirpIsFoundOnceLawsAreRuledOut) {
  const SearchContext context = context_of(
      "motion=chirp,length_s=30,left_out=gain_drift,left_out.size=-0.09,outside.force_N=25,"
      "outside.corner_Hz=2.5,outside.shake_m=1.1e-5,outside.shake_Hz=52.3,plant.mass_kg=52,"
      "plant.damping_N_s_per_m=940,plant.bulk_modulus_Pa=7.3e8,plant.dead_volume_m3=1.2e-5");
  EXPECT_FALSE(search_changes(context, first_stage(context)).explaining);
  const std::optional<ChangeSearch> found =
      search_changes(context, first_stage(context), ChangesSought::after_laws).explaining;
  ASSERT_TRUE(found.has_value());
  ASSERT_THAT(found->changes, SizeIs(1));
  const ParameterChange& change = found->changes.front();
  EXPECT_EQ(change.parameter, "valve_gain_m_per_V");
  EXPECT_EQ(change.kind, ChangeKind::ramp);
  EXPECT_NEAR(change.to / change.from, 0.91, 0.01);
}

// On the way to the gain's drift a change of the mass is taken.
TEST(LongChanges, AChangeThatStoodForAnotherIsDropped) {
  const SearchContext context = context_of(
      "motion=chirp,mismatched=1,left_out=gain_drift,left_out.size=-0.07712725666,"
      "outside.force_N=30.11193319,outside.corner_Hz=3.054727037,outside.shake_m=9.92996e-6,"
      "outside.shake_Hz=59.1037,plant.mass_kg=51.41498126,plant.damping_N_s_per_m=953.6266452,"
      "plant.bulk_modulus_Pa=718647228.8,plant.dead_volume_m3=1.179306599e-05,"
      "plant.supply_pressure_Pa=7199272.312,plant.valve_gain_m_per_V=2.798200402e-05,"
      "plant.valve_natural_frequency_rad_per_s=653.9665836,plant.valve_damping_ratio=0.6400837709",
      616390004);
  const std::optional<ChangeSearch> found =
      search_changes(context, first_stage(context), ChangesSought::after_laws).explaining;
  ASSERT_TRUE(found.has_value());
  ASSERT_THAT(found->changes, SizeIs(1));
  EXPECT_EQ(found->changes.front().parameter, "valve_gain_m_per_V");
  EXPECT_NEAR(found->changes.front().to / found->changes.front().from, 1.0 - 0.0771, 0.01);
}

TEST(LongChanges, WhatDisturbsTheRigBesideAChangeIsNamed) {
  const SearchContext context = context_of(
      "motion=multisine,length_s=20,plant.damping_N_s_per_m=1000,"
      "at9:plant.damping_N_s_per_m=1700,outside.shake_m=2e-5,outside.shake_Hz=43.217");
  const std::optional<ChangeSearch> found =
      search_changes(context, first_stage(context)).explaining;
  ASSERT_TRUE(found.has_value());
  ASSERT_THAT(found->changes, SizeIs(1));
  EXPECT_EQ(found->changes.front().parameter, "damping_N_s_per_m");
  const auto& lines = found->innovations.final.noise.lines;
  ASSERT_THAT(lines, SizeIs(1));
  EXPECT_NEAR(lines.front().frequency_Hz, 43.217, 0.01);
  EXPECT_EQ(lines.front().site, disturbance::LineSite::sensor);
}

// The offset is a candidate behind lines as well as without them.
TEST(LongChanges, ANullThatStepsIsFoundBesideAStrongLine) {
  const SearchContext context = context_of(
      "motion=multisine,length_s=20,at9:null_bias.offset_V=0.05,"
      "outside.shake_m=6e-5,outside.shake_Hz=37.411");
  const std::optional<ChangeSearch> found =
      search_changes(context, first_stage(context)).explaining;
  ASSERT_TRUE(found.has_value());
  ASSERT_THAT(found->changes, SizeIs(1));
  EXPECT_EQ(found->changes.front().parameter, "null_bias.offset_V");
  EXPECT_NEAR(found->changes.front().at_s, 9.0, 0.05);
  EXPECT_NEAR(found->changes.front().to - found->changes.front().from, 0.05, 0.005);
  EXPECT_THAT(found->innovations.final.noise.lines, SizeIs(1));
}

TEST(Changes, ANullThatDriftsIsNoMotionThatOtherParametersFollow) {
  const SearchContext context = context_of(
      "motion=multisine,length_s=30,left_out=null_drift,left_out.size=0.06,outside.force_N=20");
  const std::optional<ChangeSearch> found =
      search_changes(context, first_stage(context)).explaining;
  ASSERT_TRUE(found.has_value());
  ASSERT_THAT(found->changes, SizeIs(1));
  const ParameterChange& change = found->changes.front();
  EXPECT_EQ(change.parameter, "null_bias.offset_V");
  EXPECT_EQ(change.kind, ChangeKind::ramp);
  EXPECT_NEAR(change.to - change.from, 0.12, 0.006);
}

}  // namespace
}  // namespace estimator::greybox::selection
