// Loads that set in on records of the independent simulator (tests/truth), beside a random force.
#include "estimator/greybox/disturbance/force_jump.h"

#include <gmock/gmock.h>

#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/innovation_stage.h"
#include "estimator/greybox/selection/structure_search.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::disturbance {
namespace {

ForceJump jump_in(const std::string& spec, std::size_t seed) {
  const selection::SearchContext context = diagnose_test::context_of(spec, seed);
  const selection::InnovationStage stage = selection::settled(
      context, selection::first_stage(context), {}, selection::Settling::fully, {});
  const Dataset& record = stage.context.problem.data.records.front();
  return likeliest_jump(stage.linear.front(), record, *record.innovations,
                        stage.model.fitted.residual_m, context.problem.data.noise_floor_m);
}

const std::string kDisturbed =
    "motion=multisine,length_s=20,outside.force_N=20,outside.corner_Hz=3";

TEST(ForceJump, ALoadThatSetsInIsFoundWithTimeAndSize) {
  const ForceJump jump =
      jump_in(kDisturbed + ",left_out=load_step,left_out.size=200,left_out.where=12", 71);
  EXPECT_GT(jump.gain_nats, 30.0);
  EXPECT_NEAR(jump.time_s, 12.0, 0.02);
  EXPECT_NEAR(jump.size, 200.0, 60.0);
}

TEST(ForceJump, ARandomForceHasNone) { EXPECT_LT(jump_in(kDisturbed, 72).gain_nats, 15.0); }

TEST(ForceJump, ADiagnosisSaysWhatSetInAndWhen) {
  const selection::SearchContext context = diagnose_test::context_of(
      kDisturbed + ",left_out=load_step,left_out.size=300,left_out.where=8", 73);
  const selection::Diagnosis found = selection::diagnose(context.problem, context.options);
  EXPECT_EQ(found.verdict, selection::Verdict::changing);
  ASSERT_EQ(found.changing.size(), 1U);
  EXPECT_EQ(found.changing[0].parameter, "load_force.force_N");
  EXPECT_NEAR(found.changing[0].at_s, 8.0, 0.02);
  EXPECT_NEAR(found.changing[0].to - found.changing[0].from, 300.0,
              3.0 * found.changing[0].to_error);
  // each half of the record knows the load on one side of its change
  EXPECT_LT(found.changing[0].from_error, 20.0);
  EXPECT_LT(found.changing[0].at_error_s, 0.05);
  ASSERT_FALSE(found.where.empty());
  EXPECT_EQ(found.where[0].site, "force");
  EXPECT_EQ(found.where[0].variable, "time");
  for (const selection::Localisation& one : found.where) {
    EXPECT_TRUE(one.or_sites.empty()) << "the place of a load that sets in is known";
  }
}

// Without a filter's gain the innovations are those of an integrator: y(k+1) = y + b F, so that a
// jump of F at sample j is a ramp (k - j) b F, fitted by least squares in closed form.
TEST(ForceJump, IsLeastSquaresWhereNothingIsCorrected) {
  constexpr Eigen::Index kSamples = 50;
  constexpr Eigen::Index kFrom = 30;
  constexpr double kPerSample = 0.002;
  Linearisation model;
  StateMatrix a = StateMatrix::Zero();
  a(0, 0) = 1.0;
  a(0, kMostStates - 1) = kPerSample;
  model.transition.assign(kSamples, a);
  Dataset record;
  record.starts = {0};
  record.valid.assign(kSamples, 1);
  InnovationGains gains;
  gains.gain = Eigen::MatrixXd::Zero(2, kSamples);
  gains.decay = 1.0;
  gains.scale = Eigen::VectorXd::Ones(kSamples);
  Eigen::VectorXd ramp(kSamples);
  for (Eigen::Index k = 0; k < kSamples; ++k) {
    record.t_s.push_back(0.005 * static_cast<double>(k));
    ramp[k] = k > kFrom ? 7.0 * kPerSample * static_cast<double>(k - kFrom) : 0.0;
  }
  const ForceJump jump = likeliest_jump(model, record, gains, ramp, 1.0);
  EXPECT_DOUBLE_EQ(jump.time_s, 0.005 * kFrom);
  EXPECT_NEAR(jump.size, 7.0, 1e-9);
  EXPECT_NEAR(jump.gain_nats, 0.5 * ramp.squaredNorm(), 1e-9);
}

}  // namespace
}  // namespace estimator::greybox::disturbance
