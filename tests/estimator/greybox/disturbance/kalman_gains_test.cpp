#include "estimator/greybox/disturbance/kalman_gains.h"

#include <gmock/gmock.h>

#include <cmath>

#include "estimator/greybox/observer_simulation.h"
#include "tests/estimator/greybox/disturbance/axis_record.h"

namespace estimator::greybox::disturbance {
namespace {

using disturbance_test::axis;
using disturbance_test::axis_record;

/// y(k+1) = y(k) + walk: the smallest filter there is.
Linearisation random_walk(std::size_t samples) {
  Linearisation model;
  model.states = {"y_m"};
  StateMatrix keep = StateMatrix::Zero();
  keep(0, 0) = 1.0;
  model.transition.assign(samples, keep);
  model.from_supply.assign(samples, StateVector::Zero());
  model.speed_mps.assign(samples, 0.0);
  return model;
}

// P = P R/(P + R) + Q has the root P = (Q + sqrt(Q^2 + 4 Q R)) / 2.
TEST(KalmanGains, OfARandomWalkSettleAtTheRootOfRiccatisEquation) {
  const Dataset record = axis_record(4000);
  const NoiseParameters noise{.disturbance_sd = 0.0, .walk_m = 2e-7, .sensor_m = 3e-6};
  const KalmanGains found = kalman_gains(random_walk(4000), record, noise, 2e-6);
  const double q = noise.walk_m * noise.walk_m;
  const double r = noise.sensor_m * noise.sensor_m;
  const double p = 0.5 * (q + std::sqrt(q * q + 4.0 * q * r));
  EXPECT_NEAR(found.gains.gain(0, 3999), p / (p + r), 1e-9);
  EXPECT_NEAR(found.gains.scale[3999], 2e-6 / std::sqrt(p + r), 1e-9);
  double sum = 0.0;
  for (Eigen::Index k = 0; k < 4000; ++k) sum -= 2.0 * std::log(found.gains.scale[k]);
  EXPECT_NEAR(found.log_determinant, sum, 1e-6);
}

TEST(KalmanGains, WithoutAnyProcessNoiseTheModelIsTrusted) {
  const Dataset record = axis_record();
  const Linearisation model = linearise(axis(), record, {}, Eigen::VectorXd());
  const NoiseParameters noise{.disturbance_sd = 0.0, .walk_m = 0.0, .sensor_m = 3e-6};
  const KalmanGains found = kalman_gains(model, record, noise, 3e-6);
  EXPECT_LT(found.gains.gain.col(799).cwiseAbs().maxCoeff(), 0.01);
  EXPECT_NEAR(found.gains.scale[799], 1.0, 0.01);
}

// The variance of the weak observer's error, summed here from the impulse responses instead.
TEST(KalmanGains, TheDisturbedFloorIsThatOfTheWeakObserver) {
  const Dataset record = axis_record(3000);
  const Linearisation model = linearise(axis(), record, {}, Eigen::VectorXd());
  const double l = kObserver_per_s * record.sample_time_s;
  const NoiseParameters noise{.disturbance_sd = 0.0, .walk_m = 1e-6, .sensor_m = 1e-6};
  // without a disturbance only y matters: e(k+1) = (1 - l) e(k) + walk + l sensor
  const double variance = (1.0 + l * l) / (1.0 - (1.0 - l) * (1.0 - l)) * 1e-12 + 1e-12;
  EXPECT_NEAR(disturbed_rms_m(model, record, noise), std::sqrt(variance),
              0.03 * std::sqrt(variance));
}

}  // namespace
}  // namespace estimator::greybox::disturbance
