// Period and scatter of a repeated motion, against the numbers that the series were made of.
#include "estimator/residual/repetition.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

namespace estimator::residual {
namespace {

using Eigen::VectorXd;

/// Two harmonics over `period` samples, with independent noise of the standard deviation `noise`.
VectorXd repeated(int samples, double period, double noise, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal(0.0, noise);
  VectorXd y(samples);
  for (int i = 0; i < samples; ++i) {
    const double phase = 2.0 * std::numbers::pi * i / period;
    y[i] = 0.02 * std::sin(phase) + 0.007 * std::cos(3.0 * phase) + normal(engine);
  }
  return y;
}

TEST(Repetition, FindsThePeriodOfARepeatedMotion) {
  EXPECT_THAT(repetition_period(repeated(6000, 400.0, 1e-5, 1)), testing::Optional(400U));
  EXPECT_THAT(repetition_period(repeated(120000, 1000.0, 1e-5, 2)), testing::Optional(1000U));
  EXPECT_THAT(repetition_period(repeated(850, 400.0, 1e-5, 3)), testing::Optional(400U));
}

TEST(Repetition, FindsNoneInAMotionThatDoesNotRepeat) {
  EXPECT_EQ(repetition_period(repeated(700, 400.0, 1e-5, 4)), std::nullopt) << "too short";
  EXPECT_EQ(repetition_period(VectorXd::LinSpaced(5000, 0.0, 0.1)), std::nullopt) << "a ramp";
  EXPECT_EQ(repetition_period(VectorXd::Constant(5000, 0.1)), std::nullopt) << "standstill";
  VectorXd y(6000);
  for (int i = 0; i < y.size(); ++i) {
    y[i] = 0.02 * std::sin(0.01 * i) + 0.02 * std::sin(0.01 * std::sqrt(2.0) * i);
  }
  EXPECT_EQ(repetition_period(y), std::nullopt) << "two incommensurable sines";
}

TEST(Repetition, TellsScatterFromWhatRepeats) {
  constexpr double kScatter_m = 4e-6;
  constexpr double kRepeats_m = 9e-6;
  std::mt19937_64 engine(5);
  std::normal_distribution<double> normal(0.0, kScatter_m);
  VectorXd error(8000);
  for (int i = 0; i < error.size(); ++i) {
    error[i] =
        std::sqrt(2.0) * kRepeats_m * std::sin(2.0 * std::numbers::pi * i / 400.0) + normal(engine);
  }
  const RepetitionScatter found = repetition_scatter(error, VectorXd::Ones(error.size()), 400);
  EXPECT_NEAR(found.scatter_m(), kScatter_m, 0.03 * kScatter_m);
  EXPECT_NEAR(found.repeating_m(), kRepeats_m, 0.03 * kRepeats_m);
}

TEST(Repetition, LeavesOutWhatDoesNotCount) {
  VectorXd error = VectorXd::Zero(1200);
  VectorXd weights = VectorXd::Ones(1200);
  error.head(400).setConstant(1.0);
  weights.head(400).setZero();
  EXPECT_EQ(repetition_scatter(error, weights, 400).scatter_m(), 0.0);
  EXPECT_EQ(repetition_scatter(error, weights, 400).repeating_m(), 0.0);
  EXPECT_TRUE(std::isnan(repetition_scatter(error.head(400), weights.head(400), 400).scatter_m()));
}

}  // namespace
}  // namespace estimator::residual
