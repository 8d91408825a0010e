// Laws found by simulations alone: by themselves, beside an effect, or in the place of one that
// bends the plant.
#include "estimator/greybox/selection/simulated_laws.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "tests/estimator/greybox/selection/servo_problem.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::context_of;
using diagnose_test::kServoGain;
using diagnose_test::servo_context;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using testing::UnorderedElementsAre;

double behind_band(double u_V, double half_width_V) {
  return u_V - std::clamp(u_V, -half_width_V, half_width_V);
}

Diagnosis explained(const SearchContext& context, bool expected) {
  Diagnosis d;
  d.noise_floor_m = context.problem.data.noise_floor_m;
  EXPECT_EQ(explain_by_laws(context, start_search(context), d), expected);
  return d;
}

TEST(SimulatedLaws, ALawBesideADeadBandIsFoundWithIt) {
  constexpr double kBand_V = 0.15;
  constexpr double kFull_V = 1.2;
  const SearchContext context =
      servo_context({.rate_mps =
                         [](double u_V, double, double) {
                           const double open_V = behind_band(u_V, kBand_V);
                           return kServoGain * open_V / std::hypot(1.0, open_V / kFull_V);
                         },
                     .samples = 2400});
  const Diagnosis d = explained(context, true);
  EXPECT_EQ(d.verdict, Verdict::learned);
  EXPECT_THAT(d.missing, UnorderedElementsAre("deadband", "root_saturation"));
  EXPECT_NEAR(d.final.value("deadband.half_width_V"), kBand_V, 1e-3);
  EXPECT_NEAR(d.final.value("gain_mps_per_V"), kServoGain, 2e-3 * kServoGain);
}

// Two more parameters explain it, and the damping of the plant at its bound.
TEST(LongSimulatedLaws, AnEffectThatBendsThePlantGivesWayToALaw) {
  const SearchContext context =
      context_of("motion=multisine,length_s=20,left_out=power_damping,left_out.size=8000", 27);
  const Diagnosis d = explained(context, true);
  ASSERT_THAT(d.laws, SizeIs(1));
  EXPECT_THAT(d.missing, ElementsAre("power_damping"));
  EXPECT_NEAR(d.final.value("power_damping.exponent"), 1.5, 0.06);
}

TEST(SimulatedLaws, NoneIsTakenWhereEffectsExplainTheRecord) {
  const SearchContext context =
      servo_context({.rate_mps = [](double u_V, double,
                                    double) { return kServoGain * behind_band(u_V + 0.1, 0.15); },
                     .samples = 2400});
  EXPECT_THAT(explained(context, false).laws, IsEmpty());
}

}  // namespace
}  // namespace estimator::greybox::selection
