#include "estimator/greybox/disturbance/linearisation.h"

#include <gmock/gmock.h>

#include "tests/estimator/greybox/disturbance/axis_record.h"

namespace estimator::greybox::disturbance {
namespace {

using disturbance_test::axis;
using disturbance_test::axis_record;
using disturbance_test::kTs_s;

// M v' = -d v - F over one sample, y' = v, solved exactly.
TEST(Linearisation, OfAnAxisIsTheExactTransitionOverASample) {
  plant_sim::ModelFile model = axis();
  const double mass_kg = *model.value("mass_kg");
  const double damping_N_s_per_m = *model.value("damping_N_s_per_m");
  const Linearisation linear = linearise(model, axis_record(), {}, Eigen::VectorXd());
  ASSERT_THAT(linear.states, testing::ElementsAre("y_m", "v_mps"));
  EXPECT_TRUE(linear.force);
  EXPECT_FALSE(linear.supply);
  const double a_per_s = damping_N_s_per_m / mass_kg;
  const double decay = std::exp(-a_per_s * kTs_s);
  const double travel_s = (1.0 - decay) / a_per_s;
  for (const std::size_t k : {0U, 100U, 799U}) {
    const StateMatrix& a = linear.transition[k];
    EXPECT_NEAR(a(0, 0), 1.0, 1e-8);
    EXPECT_NEAR(a(0, 1), travel_s, 1e-7);
    EXPECT_NEAR(a(1, 0), 0.0, 1e-6);
    EXPECT_NEAR(a(1, 1), decay, 1e-7);
    EXPECT_NEAR(a(0, kMostStates - 1), -(kTs_s - travel_s) / damping_N_s_per_m, 1e-10);
    EXPECT_NEAR(a(1, kMostStates - 1), -(1.0 - decay) / damping_N_s_per_m, 1e-8);
  }
}

TEST(Linearisation, LeavesDryFrictionOutOfTheSlopes) {
  plant_sim::ModelFile rough = axis();
  *rough.value("friction.coulomb_N") = 50.0;
  *rough.value("friction.static_N") = 80.0;
  *rough.value("friction.stribeck_mps") = 0.01;
  for (auto& effect : rough.effects) effect.present = effect.name == "friction";
  const Linearisation with = linearise(rough, axis_record(), {}, Eigen::VectorXd());
  const Linearisation without = linearise(axis(), axis_record(), {}, Eigen::VectorXd());
  for (const std::size_t k : {0U, 400U}) {
    EXPECT_NEAR((with.transition[k] - without.transition[k]).norm(), 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace estimator::greybox::disturbance
