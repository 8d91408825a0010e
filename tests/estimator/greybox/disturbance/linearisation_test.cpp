#include "estimator/greybox/disturbance/linearisation.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>

#include "estimator/greybox/observer_simulation.h"
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

// The model's own readings, without noise: they rest while the gap is open.
TEST(Linearisation, AGapIsOpenWhileTheReadingRests) {
  plant_sim::ModelFile model = axis();
  *model.value("backlash.width_m") = 3e-4;
  for (auto& effect : model.effects) effect.present = effect.name == "backlash";
  Dataset record = axis_record();
  EXPECT_THAT(linearise(model, record, {}, Eigen::VectorXd()).gap_m, testing::IsEmpty());
  record.valid.assign(record.size(), 0);
  ObserverSimulation run(model, record, {}, 0.0);
  Eigen::MatrixXd residuals_m;
  run.residuals(Eigen::VectorXd(), residuals_m);
  record.y_m = run.predicted().reading_m;
  record.valid.assign(record.size(), 1);
  InnovationGains gains;
  gains.states = {"y_m", "v_mps"};
  gains.gain = Eigen::MatrixXd::Zero(3, static_cast<Eigen::Index>(record.size()));
  gains.scale = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(record.size()));
  record.innovations = std::make_shared<const InnovationGains>(gains);
  const Linearisation linear = linearise(model, record, {}, Eigen::VectorXd());
  ASSERT_EQ(linear.gap_m.size(), record.size());
  int open = 0;
  for (std::size_t k = 2; k < record.size(); ++k) {
    const double moved_m = std::abs(record.y_m[k] - record.y_m[k - 1]);
    if (linear.gap_m[k] > 1e-9) {
      EXPECT_LT(moved_m, 1e-12) << k;
      ++open;
    } else if (linear.gap_m[k] < -1e-9) {
      EXPECT_GT(moved_m, 0.0) << k;
    }
  }
  EXPECT_GT(open, 20);
}

}  // namespace
}  // namespace estimator::greybox::disturbance
