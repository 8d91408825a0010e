#include "estimator/greybox/kinematics.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace estimator::greybox {

namespace {

Dataset record(double sample_time_s, std::size_t samples,
               const std::function<double(double)>& y_m) {
  Dataset m;
  m.sample_time_s = sample_time_s;
  for (std::size_t k = 0; k < samples; ++k) {
    m.t_s.push_back(sample_time_s * static_cast<double>(k));
    m.u_V.push_back(0.0);
    m.y_m.push_back(y_m(m.t_s.back()));
    m.valid.push_back(1);
  }
  m.starts = {0};
  return m;
}

TEST(Motion, IsExactForConstantAccelerationAtAnyRateAndAtTheEnds) {
  for (const double sample_time_s : {0.02, 0.0077531, 0.005, 0.001}) {
    const Dataset m =
        record(sample_time_s, 300, [](double t) { return 0.3 - 0.05 * t + 0.5 * 0.2 * t * t; });
    const Kinematics found = kinematics(m, 0.0);
    for (std::size_t k = 0; k < m.size(); ++k) {
      ASSERT_NEAR(found.speed_mps[k], -0.05 + 0.2 * m.t_s[k], 1e-9);
      ASSERT_NEAR(found.acceleration_mps2[k], 0.2, 1e-6);
    }
  }
}

// Slope of n = 2 h + 1 points of white noise s: s / (Ts sqrt(h (h + 1) (2 h + 1) / 3)).
TEST(Motion, HasTheNoiseOfALeastSquaresSlope) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 2.5e-6);
  const Dataset m = record(0.005, 20000, [&](double) { return noise(random); });
  const Kinematics found = kinematics(m, 2.5e-6);
  double squares = 0.0;
  for (const double v : found.speed_mps) squares += v * v;
  const double expected_mps = 2.5e-6 / (0.005 * std::sqrt(10.0 * 11.0 * 21.0 / 3.0));
  EXPECT_NEAR(std::sqrt(squares / 20000.0), expected_mps, 0.05 * expected_mps);
  EXPECT_NEAR(found.rest_mps, 4.0 * expected_mps, 1e-9);
}

TEST(Motion, TellsExtendingReversingAndRetractingOfASineApart) {
  // 0.5 Hz: turns at 0.5 s, 1.5 s, ...
  const Dataset m = record(0.005, 1000, [](double t) { return 0.02 * std::sin(M_PI * t); });
  const Kinematics found = kinematics(m, 0.0);
  EXPECT_EQ(found.direction[40], Direction::extending);   // 0.2 s
  EXPECT_EQ(found.direction[100], Direction::reversing);  // 0.5 s
  EXPECT_EQ(found.direction[105], Direction::reversing);
  EXPECT_EQ(found.direction[120], Direction::retracting);  // 0.6 s
  EXPECT_EQ(found.direction[240], Direction::retracting);  // 1.2 s
  EXPECT_EQ(found.direction[300], Direction::reversing);   // 1.5 s
}

TEST(Motion, CallsAStandstillRestAndNotAReversal) {
  // Out for one second, still for two, back for one.
  const Dataset m = record(0.005, 800, [](double t) {
    return t < 1.0 ? 0.05 * t : (t < 3.0 ? 0.05 : 0.05 - 0.05 * (t - 3.0));
  });
  const Kinematics found = kinematics(m, 1e-6);
  EXPECT_EQ(found.direction[100], Direction::extending);
  EXPECT_EQ(found.direction[400], Direction::resting);
  EXPECT_EQ(found.direction[700], Direction::retracting);
  EXPECT_EQ(std::count(found.direction.begin(), found.direction.end(), Direction::reversing), 0);
}

TEST(Motion, DoesNotLookAcrossAGap) {
  Dataset m = record(0.005, 600, [](double t) { return t < 1.5 ? 0.01 * t : 0.2 - 0.01 * t; });
  m.starts = {0, 300};
  const Kinematics found = kinematics(m, 0.0);
  EXPECT_NEAR(found.speed_mps[299], 0.01, 1e-9);
  EXPECT_NEAR(found.speed_mps[300], -0.01, 1e-9);
  EXPECT_EQ(std::count(found.direction.begin(), found.direction.end(), Direction::reversing), 0);
}

}  // namespace
}  // namespace estimator::greybox
