// The conclusion about an effect that a search has taken depends on its size.
#include "estimator/greybox/selection/conclusion.h"

#include <gmock/gmock.h>

#include <cmath>

#include "estimator/greybox/selection/first_stage.h"
#include "tests/estimator/greybox/selection/servo_problem.h"

namespace estimator::greybox::selection {
namespace {

/// The conclusion of a search that has taken an offset of the command, of which there are
/// `offset_V`.
Diagnosis concluded(double offset_V) {
  const SearchContext context =
      diagnose_test::servo_context({.rate_mps = diagnose_test::with_offset(offset_V)});
  const ModelStage first = first_stage(context);
  Diagnosis result;
  result.noise_floor_m = context.problem.data.noise_floor_m;
  result.search.path = {first, diagnose_test::stage_with(context, first, {{"null_bias", 1e-6}})};
  result.search.final = result.search.path.back();
  conclude(context, context, result);
  return result;
}

TEST(Conclusion, NothingIsMissingWhereTheOnlyEffectIsWithinItsError) {
  const Diagnosis d = concluded(0.0);
  EXPECT_EQ(d.verdict, Verdict::nothing_missing);
  EXPECT_THAT(d.missing, testing::IsEmpty());
  EXPECT_TRUE(std::isnan(d.final.value("null_bias.offset_V")));
}

TEST(Conclusion, AnEffectOfItsSizeIsMissing) {
  const Diagnosis d = concluded(0.01);
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_THAT(d.missing, testing::ElementsAre("null_bias"));
}

}  // namespace
}  // namespace estimator::greybox::selection
