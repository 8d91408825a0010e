// A dead band of the amplifier, ahead of a valve that follows slowly, is told from overlap of the
// spool behind it. Truth: tests/truth.
#include <gmock/gmock.h>

#include <string>

#include "estimator/greybox/selection/diagnosis.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

// Tolerances of some ten standard errors each.
constexpr double kWidth_V = 1e-3;
constexpr double kWhole_ratio = 0.01;  ///< share at its bound
constexpr double kShare_ratio = 0.05;  ///< share between its bounds

Diagnosis found_in(const std::string& band, std::size_t seed) {
  const truth::Record truth = truth::simulate(
      truth::parse_case("rig=single_rod,motion=multisine,length_s=12," + band, seed));
  return diagnose(make_problem(diagnose_test::single_rod(),
                               fit_dataset({diagnose_test::dataset_of(truth)}, {})),
                  {});
}

ParameterValue value_of(const Diagnosis& d, const std::string& name) {
  for (const ParameterValue& p : d.parameters) {
    if (p.name == name) return p;
  }
  ADD_FAILURE() << name;
  return {};
}

TEST(AmplifierDeadband, IsNamedAsTheWholeBand) {
  const Diagnosis d = found_in("deadband.half_width_V=0.4,deadband.ahead_ratio=1", 643);
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_THAT(d.missing, testing::ElementsAre("deadband"));
  EXPECT_NEAR(value_of(d, "deadband.half_width_V").value, 0.4, kWidth_V);
  EXPECT_NEAR(value_of(d, "deadband.ahead_ratio").value, 1.0, kWhole_ratio);
}

TEST(AmplifierDeadband, IsNamedAsItsShareBesideOverlap) {
  const Diagnosis d = found_in("deadband.half_width_V=0.4,deadband.ahead_ratio=0.4", 644);
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_THAT(d.missing, testing::ElementsAre("deadband"));
  const ParameterValue share = value_of(d, "deadband.ahead_ratio");
  EXPECT_NEAR(share.value, 0.4, kShare_ratio);
  EXPECT_NEAR(share.value, 0.4, 3.0 * share.std_error);
}

// The share is a refinement: what is all overlap has none.
TEST(AmplifierDeadband, IsNotFoundInOverlap) {
  const Diagnosis d = found_in("deadband.half_width_V=0.4", 645);
  EXPECT_THAT(d.missing, testing::ElementsAre("deadband"));
  for (const ParameterValue& p : d.parameters) EXPECT_NE(p.name, "deadband.ahead_ratio");
}

}  // namespace
}  // namespace estimator::greybox::selection
