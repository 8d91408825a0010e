// Fits from other starts: when a quick look is given up, and that threads change nothing.
#include "estimator/greybox/selection/other_fits.h"

#include <gmock/gmock.h>

#include <limits>

#include "estimator/greybox/selection/structure_search.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

/// A parabola in two parameters without priors, -2 log L = (a^2 + 4 b^2) / floor^2.
FitSummary at(double a, double b) {
  FitSummary fitted;
  for (const char* name : {"a", "b"}) {
    FreeParameter parameter;
    parameter.name = name;
    parameter.prior_sd = std::numeric_limits<double>::infinity();
    fitted.parameters.push_back(parameter);
  }
  fitted.theta = Eigen::Vector2d(a, b);
  fitted.jacobian = Eigen::Matrix2d::Identity();
  fitted.jacobian(1, 1) = 2.0;
  return fitted;
}

TEST(IsOnTheWay, WhereTheSlopesExpectTheLag) {
  const FitSummary best = at(0.0, 0.0);
  EXPECT_TRUE(is_on_the_way(best, at(3.0, 0.0), 9.0, 1.0));
  EXPECT_TRUE(is_on_the_way(best, at(0.3, 0.1), 0.2, 1.0));
  EXPECT_TRUE(is_on_the_way(best, at(6.0, 0.0), 9.0, 2.0));
  EXPECT_FALSE(is_on_the_way(best, at(3.0, 2.0), 9.0, 1.0)) << "another optimum";
  EXPECT_FALSE(is_on_the_way(best, at(0.3, 0.1), -0.2, 1.0)) << "likelier";
  EXPECT_FALSE(is_on_the_way(best, at(9.0, 0.0), 81.0, 1.0)) << "slopes do not hold so far";
}

TEST(IsOnTheWay, NotWithOtherParametersOrWithoutSlopes) {
  FitSummary best = at(0.0, 0.0);
  FitSummary other = at(3.0, 0.0);
  other.parameters[1].name = "c";
  EXPECT_FALSE(is_on_the_way(best, other, 9.0, 1.0));
  best.jacobian.col(1).setZero();
  EXPECT_TRUE(is_on_the_way(best, at(3.0, 0.0), 9.0, 1.0));
  EXPECT_FALSE(is_on_the_way(best, at(3.0, 0.1), 9.0, 1.0)) << "b moves nothing at the optimum";
  best.jacobian.resize(0, 0);
  EXPECT_FALSE(is_on_the_way(best, at(3.0, 0.0), 9.0, 1.0));
}

// Several widths of a play are tried side by side.
TEST(LikeliestFit, StagesAreTheSameForAnyNumberOfThreads) {
  SearchContext context = diagnose_test::context_of(
      "motion=multisine,length_s=8,backlash.width_m=0.0002,outside.force_N=20", 85);
  const SearchStart start = start_search(context);
  ASSERT_THAT(start.branch.stage.added, testing::ElementsAre("backlash"));
  const auto reached = [&](unsigned threads) {
    return settled(context, start.branch.stage, {}, Settling::fully, wide(threads));
  };
  const InnovationStage one = reached(1);
  const InnovationStage several = reached(3);
  EXPECT_EQ(one.minus_two_log, several.minus_two_log);
  EXPECT_EQ(one.model.fitted.theta, several.model.fitted.theta);
}

}  // namespace
}  // namespace estimator::greybox::selection
