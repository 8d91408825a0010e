// No effect is missing that leaves a simulation worse on samples that did not fit it.
#include <gmock/gmock.h>

#include <cmath>

#include "estimator/greybox/selection/diagnosis.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::context_with;

constexpr std::size_t kSeed = 3;

TEST(LongWorth, ACommandThatIsLoggedInTenthsOfAVoltIsNoMissingEffect) {
  truth::Record record = truth::simulate(truth::parse_case("motion=multisine,length_s=6", kSeed));
  for (double& u_V : record.u_V) u_V = 0.1 * std::round(10.0 * u_V);
  SearchContext context = context_with(diagnose_test::dataset_of(record));
  context.problem.effects_only = true;
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_THAT(d.established(), testing::IsEmpty());
  EXPECT_LE(d.rms_after_m, 1.05 * d.rms_before_m);
}

}  // namespace
}  // namespace estimator::greybox::selection
