// Two effects that make up for each other: alone neither leaves less.
#include "estimator/greybox/selection/selection_path.h"

#include <gmock/gmock.h>

#include <cmath>

#include "estimator/greybox/selection/first_stage.h"
#include "tests/estimator/greybox/selection/servo_problem.h"

namespace estimator::greybox::selection {
namespace {

using testing::ElementsAre;
using testing::SizeIs;
using testing::UnorderedElementsAre;

/// An offset that an asymmetry takes back on average: the loop keeps the rod about its middle.
diagnose_test::Rate hidden_offset(double offset_V, double asymmetry_ratio) {
  return [=](double u_V, double, double) {
    const double x_V = u_V + offset_V;
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
