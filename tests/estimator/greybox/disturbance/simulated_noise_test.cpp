#include "estimator/greybox/disturbance/simulated_noise.h"

#include <gtest/gtest.h>

#include "estimator/greybox/disturbance/linearisation.h"
#include "tests/estimator/greybox/disturbance/axis_record.h"

namespace estimator::greybox::disturbance {
namespace {

using disturbance_test::axis;
using disturbance_test::axis_record;

NoiseParameters random_force(double sd_N) {
  NoiseParameters noise;
  noise.disturbance_sd = sd_N;
  noise.corner_Hz = 2.0;
  return noise;
}

// Seven courses of 20 s that the observer forgets within half a second: 6 % of the RMS is chance.
TEST(SimulatedNoise, OfALinearAxisIsWhatItsLinearisationSays) {
  const plant_sim::ModelFile model = axis();
  const Dataset record = axis_record(4000);
  const Linearisation linear = linearise(model, record, {}, Eigen::VectorXd());
  const NoiseParameters noise = random_force(3.0);
  const double expected_m = disturbed_rms_m(linear, record, noise);
  EXPECT_NEAR(simulated_disturbance_rms_m(model, record, {}, Eigen::VectorXd(), noise), expected_m,
              0.2 * expected_m);
  EXPECT_EQ(simulated_disturbance_rms_m(model, record, {}, Eigen::VectorXd(), random_force(0.0)),
            0.0);
}

TEST(SimulatedNoise, IsHeldByFrictionAtRest) {
  plant_sim::ModelFile rough = axis();
  Dataset record = axis_record();
  for (double& u_V : record.u_V) u_V = 0.0;
  for (double& y_m : record.y_m) y_m = 0.0;
  const NoiseParameters noise = random_force(3.0);
  EXPECT_GT(simulated_disturbance_rms_m(rough, record, {}, Eigen::VectorXd(), noise), 1e-4);
  *rough.value("friction.coulomb_N") = 50.0;
  EXPECT_LT(simulated_disturbance_rms_m(rough, record, {}, Eigen::VectorXd(), noise), 1e-9);
}

}  // namespace
}  // namespace estimator::greybox::disturbance
