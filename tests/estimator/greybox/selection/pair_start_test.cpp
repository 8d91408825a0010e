// Pairs of effects where two taken one after another leave physics.
#include "estimator/greybox/selection/structure_search.h"

#include <gmock/gmock.h>

#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

SearchStart first_two_effects(const SearchContext& context) {
  SearchStart start = start_search(context);
  if (start.branch.stage.added.size() == 1) add_second_effect(context, start);
  return start;
}

TEST(PairStart, FindsTwoThatPassForTwoOthersOneByOne) {
  const SearchContext context = diagnose_test::context_of(
      "motion=multisine,length_s=30,external_leakage.conductance_m3ps_per_Pa=3.7e-13,"
      "load_force.force_N=-450",
      81);
  SearchStart start = first_two_effects(context);
  const double one_by_one_m = start.branch.stage.fitted.validation_rms_m;
  EXPECT_GT(one_by_one_m, 1.5 * context.problem.data.noise_floor_m) << "nothing to be found";
  prefer_pair(context, start);
  EXPECT_THAT(start.branch.stage.added,
              testing::UnorderedElementsAre("external_leakage", "load_force"));
  EXPECT_LT(start.branch.stage.fitted.validation_rms_m, 1.15 * context.problem.data.noise_floor_m);
}

TEST(PairStart, StaysWhereNoPairExplainsTheRecord) {
  const SearchContext context = diagnose_test::context_of(
      "motion=multisine,length_s=20,left_out=cubic_damping,left_out.size=100000", 82);
  SearchStart start = first_two_effects(context);
  const std::vector<std::string> before = start.branch.stage.added;
  const double before_m = start.branch.stage.fitted.validation_rms_m;
  prefer_pair(context, start);
  EXPECT_EQ(start.branch.stage.added, before);
  EXPECT_EQ(start.branch.stage.fitted.validation_rms_m, before_m);
}

}  // namespace
}  // namespace estimator::greybox::selection
