#include "estimator/free_run.h"

#include <gmock/gmock.h>

#include "tests/estimator/data.h"

namespace estimator {
namespace {

using namespace testing_data;
using testing::ElementsAre;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(FreeRun, FollowsTheClosedFormOfAFirstOrderStepResponse) {
  // y(t) = 0.9 y(t-1) + 0.2 u(t-1), u = 1: y(t) = 2 - 2 * 0.9^t from y(0) = 0
  const std::vector<double> theta{-0.9, 0.2};
  const std::vector<double> u_V(100, 1.0);
  const std::vector<double> y_m(100, 0.0);
  const auto run = free_run({1, 1, 1, false}, theta, u_V, y_m);
  for (int t = 0; t < 100; ++t) EXPECT_NEAR(run[t], 2.0 - 2.0 * std::pow(0.9, t), 1e-14);
}

TEST(FreeRun, StartsFromTheMeasuredSamplesAndIgnoresTheRest) {
  const Structure s{2, 1, 3, true};
  const std::vector<double> theta{-1.0, 0.5, 2.0, 0.25};
  const std::vector<double> u_V{1, 2, 3, 4, 5, 6};
  // y(t) = y(t-1) - 0.5 y(t-2) + 2 u(t-3) + 0.25
  EXPECT_THAT(free_run(s, theta, u_V, std::vector<double>{7, 8, 9, -1, -1, -1}),
              ElementsAre(7, 8, 9, 7.25, 7.25 - 4.5 + 4.25, 7.0 - 3.625 + 6.25));
}

TEST(FreeRun, ReproducesNoiseFreeData) {
  const Data data = excited(1000, 0.0, 1);
  const auto run = free_run(kTruth, kTruthTheta, data.u_V, data.y_m);
  EXPECT_LT(compare(data.y_m, run, kTruth.history()).rms_m, 1e-16);
  const auto errors = one_step_errors(kTruth, kTruthTheta, data.u_V, data.y_m);
  EXPECT_TRUE(std::isnan(errors[1]));
  EXPECT_EQ(summarize(errors).samples, 998);
  EXPECT_LT(summarize(errors).rms_m, 1e-17);
}

TEST(OneStepErrors, AreTheNoiseOfTheEquationAndMissingWhereDataAre) {
  Data data = excited(20'000, 1e-6, 2);
  EXPECT_NEAR(summarize(one_step_errors(kTruth, kTruthTheta, data.u_V, data.y_m)).rms_m, 1e-6,
              3e-8);  // 4 sigma of the rms of 20,000 normal values: 2e-8
  data.y_m[100] = kNan;
  const auto errors = one_step_errors(kTruth, kTruthTheta, data.u_V, data.y_m);
  EXPECT_EQ(summarize(errors).samples, 19'998 - 3);
}

TEST(Compare, SumsSquaresOverWhatBothHave) {
  const std::vector<double> measured{1, 2, 3, 4};
  const std::vector<double> predicted{9, 2, 1, 5};
  const Fit fit = compare(measured, predicted, 1);
  EXPECT_EQ(fit.samples, 3);
  EXPECT_DOUBLE_EQ(fit.cost_m2, 5.0);
  EXPECT_DOUBLE_EQ(fit.rms_m, std::sqrt(5.0 / 3.0));
  EXPECT_EQ(compare(measured, std::vector<double>{1, kNan, 3, 4}).cost_m2,
            std::numeric_limits<double>::infinity());
  EXPECT_EQ(compare(std::vector<double>{kNan, 2, 3, 4}, predicted).samples, 3);
  EXPECT_TRUE(std::isnan(compare(measured, predicted, 4).rms_m));
}

TEST(Compare, PutsAPredictionOutOfStepByWholeSamples) {
  // A sine one sample out of step: sum of squares = 400 * 2 (A sin(w/2))^2 / ... = 800 A^2
  // sin^2(w/2)
  std::vector<double> sine;
  const double w = 2.0 * 3.14159265358979 / 400.0;
  for (int t = 0; t < 401; ++t) sine.push_back(0.0254 * std::sin(w * t));
  const double expected = 800.0 * 0.0254 * 0.0254 * std::pow(std::sin(w / 2.0), 2);
  EXPECT_NEAR(compare(sine, sine, 0, 1).cost_m2, expected, 1e-12);
  EXPECT_NEAR(compare(sine, sine, 0, -1).cost_m2, expected, 1e-12);
  EXPECT_EQ(compare(sine, sine, 0, 1).samples, 400);
  const std::vector<double> late{0, 1, 2, 3};
  EXPECT_EQ(compare(std::vector<double>{5, 0, 1, 2}, late, 0, 1).cost_m2, 0.0);
}

}  // namespace
}  // namespace estimator
