// Two effects that make up for each other: alone neither leaves less.
#include "estimator/greybox/selection/selection_path.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "estimator/greybox/selection/first_stage.h"
#include "tests/estimator/greybox/selection/servo_problem.h"

namespace estimator::greybox::selection {
namespace {

using testing::ElementsAre;
using testing::SizeIs;
using testing::UnorderedElementsAre;

/// An offset that an asymmetry takes back on average: the loop keeps the rod about its middle.
diagnose_test::Rate hidden_offset(double offset_V, double asymmetry_ratio, double band_V = 0.0) {
  return [=](double u_V, double, double) {
    const double v_V = u_V + offset_V;
    const double x_V = v_V - std::clamp(v_V, -band_V, band_V);
    return diagnose_test::kServoGain * (x_V + asymmetry_ratio * std::abs(x_V));
  };
}

TEST(SelectionPath, TakesTwoThatMakeUpForEachOtherInOneStep) {
  const SearchContext context =
      diagnose_test::servo_context({.rate_mps = hidden_offset(0.08, -0.1)});
  const ModelStage first = first_stage(context);
  const ModelStage both =
      diagnose_test::stage_with(context, first, {{"null_bias", 0.08}, {"flow_asymmetry", -0.1}});
  const std::vector<ModelStage> path = path_to(context, first, both);
  ASSERT_THAT(path, SizeIs(2));
  EXPECT_THAT(path.back().added, UnorderedElementsAre("null_bias", "flow_asymmetry"));
  EXPECT_EQ(path.back().fitted.validation_rms_m, both.fitted.validation_rms_m);
  CrossValidation halves(context);
  const std::vector<ModelStage> kept = cross_validated_path(context, halves, path);
  ASSERT_THAT(kept, SizeIs(2));
  EXPECT_EQ(kept.back().added, path.back().added);
}

/// Path to an offset, the asymmetry that takes it back, and a dead band.
std::vector<ModelStage> path_to_three(double hidden_band_V) {
  const SearchContext context =
      diagnose_test::servo_context({.rate_mps = hidden_offset(0.08, -0.1, hidden_band_V)});
  const ModelStage first = first_stage(context);
  return path_to(context, first,
                 diagnose_test::stage_with(
                     context, first,
                     {{"deadband", hidden_band_V}, {"null_bias", 0.08}, {"flow_asymmetry", -0.1}}));
}

TEST(SelectionPath, TakesABystanderAfterTheTwoThatNeedEachOther) {
  const std::vector<ModelStage> path = path_to_three(0.0);
  ASSERT_THAT(path, SizeIs(3));
  EXPECT_THAT(path[1].added, UnorderedElementsAre("null_bias", "flow_asymmetry"));
  EXPECT_EQ(path[2].added.back(), "deadband");
}

TEST(SelectionPath, TakesThreeInOneStepWhereEachIsNeeded) {
  EXPECT_THAT(path_to_three(0.02), SizeIs(2));
}

TEST(SelectionPath, TakesOneByOneWhatHelpsOneByOne) {
  const SearchContext context =
      diagnose_test::servo_context({.rate_mps = hidden_offset(0.08, 0.1)});
  const ModelStage first = first_stage(context);
  const ModelStage both =
      diagnose_test::stage_with(context, first, {{"null_bias", 0.08}, {"flow_asymmetry", 0.1}});
  EXPECT_THAT(path_to(context, first, both), SizeIs(3));
}

}  // namespace
}  // namespace estimator::greybox::selection
