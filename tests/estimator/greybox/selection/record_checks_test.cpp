// Records of the independent simulator with what users get wrong in theirs.
#include "estimator/greybox/selection/record_checks.h"

#include <gmock/gmock.h>

#include "estimator/greybox/selection/structure_search.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::context_with;
using diagnose_test::dataset_of;

Dataset record() {
  return dataset_of(truth::simulate(truth::parse_case("motion=multisine,length_s=10", 51)));
}

RecordChecks checked(Dataset data) {
  const SearchContext context = context_with(std::move(data));
  return check_records(context, first_stage(context).fitted.validation_rms_m);
}

TEST(RecordChecks, ATurnedCommandIsNoticed) {
  Dataset turned = record();
  for (double& u_V : turned.u_V) u_V = -u_V;
  const RecordChecks checks = checked(turned);
  EXPECT_TRUE(checks.turned_sign());
  ASSERT_EQ(checks.responses.size(), 1U);
  EXPECT_TRUE(checks.responses.front().against_command());
  EXPECT_FALSE(checked(record()).turned_sign());
}

TEST(RecordChecks, APositionOutsideTheStrokeIsNoticed) {
  Dataset off = record();
  for (double& y_m : off.y_m) y_m -= 0.305;
  const RecordChecks checks = checked(off);
  EXPECT_LT(checks.below_m, 0.0);
  EXPECT_EQ(checks.beyond_m, 0.0);
  EXPECT_FALSE(checked(record()).outside_stroke());
}

// A valve and its cylinder follow the command by speed: a servo comes near, an axis does not, nor
// does a cylinder of other sizes.
TEST(RecordChecks, TheOtherPlantsAreRankedByWhatTheyLeave) {
  const std::vector<PlantFit> plants = fit_other_plants(context_with(record()));
  ASSERT_EQ(plants.size(), 3U);
  EXPECT_EQ(plants.front().plant, "velocity_servo");
  EXPECT_LT(3.0 * plants[0].validation_rms_m, plants[1].validation_rms_m);
}

}  // namespace
}  // namespace estimator::greybox::selection
