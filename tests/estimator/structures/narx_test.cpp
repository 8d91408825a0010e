#include "estimator/structures/narx.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimator/free_run.h"
#include "estimator/structures/prediction_error.h"
#include "tests/estimator/structures/data.h"

namespace estimator::structures {
namespace {

using namespace testing_data;

/// y(t) = 0.8 y(t-1) + 0.5 tanh(2 u(t-1)) + e: a valve that saturates.
Record saturating(int count, double noise_m, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Record out;
  double y = 0.0;
  double u = 0.0;
  for (int t = 0; t < count; ++t) {
    y = 0.8 * y + 0.5 * std::tanh(2.0 * u) + noise_m * normal(random);
    u = normal(random);
    out.y_m.push_back(y);
    out.u_V.push_back(u);
  }
  return out;
}

double held_out_rms(const std::vector<double>& errors) { return summarize(errors).rms_m; }

TEST(Narx, ReachesTheNoiseOnAValveThatSaturatesAndArxDoesNot) {
  const Record fitted = saturating(2000, 0.02, 1);
  const Record other = saturating(2000, 0.02, 2);
  const NarxFit fit = fit_narx({.n = 1, .m = 1, .hidden = 3}, fitted.all());
  ASSERT_TRUE(fit.valid) << fit.why;
  EXPECT_NEAR(held_out_rms(one_step_errors(fit, other.all()[0])), 0.02, 0.002);
  const PolynomialFit arx = fit_prediction_error({.a = 1, .b = 1, .constant = true}, fitted.all());
  EXPECT_GT(held_out_rms(one_step_errors(arx.model, other.all()[0])), 0.1);
  // Free run: the noise of an autoregression, 0.02 / sqrt(1 - 0.64).
  const Fit free = compare(other.y_m, free_run(fit, other.all()[0]), 1);
  EXPECT_NEAR(free.rms_m, 0.02 / 0.6, 0.01);
}

TEST(Narx, LinearisesToTheSlopesAtTheMean) {
  const NarxFit fit = fit_narx({.n = 1, .m = 1, .hidden = 3}, saturating(4000, 0.01, 3).all());
  ASSERT_TRUE(fit.valid) << fit.why;
  const std::vector<double> slopes = fit.linearised();
  EXPECT_NEAR(slopes[0], -0.8, 0.02);
  EXPECT_NEAR(slopes[1], 1.0, 0.1);  // 0.5 * 2 at u = 0
  // Against differences of the network itself.
  const Eigen::VectorXd up = fit.mean + Eigen::VectorXd::Unit(2, 1) * 1e-5;
  const Eigen::VectorXd down = fit.mean - Eigen::VectorXd::Unit(2, 1) * 1e-5;
  EXPECT_NEAR(slopes[1], (fit.predict_m(up) - fit.predict_m(down)) / 2e-5, 1e-6);
}

TEST(Narx, IsNoWorseThanArxOnALinearSystem) {
  const Polynomial truth{.a = {-1.5, 0.7}, .b = {1.0}, .c = {}, .d = {}, .f = {}};
  const Record fitted = random_record(truth, 1000, 0.2, 4);
  const Record other = random_record(truth, 4000, 0.2, 5);
  const NarxFit fit = fit_narx({}, fitted.all());
  ASSERT_TRUE(fit.valid) << fit.why;
  // 28 weights on 750 rows cost at most 28 / 750 / 2 = 1.9 % without early stopping and decay.
  EXPECT_LT(held_out_rms(one_step_errors(fit, other.all()[0])), 0.2 * 1.025);
}

TEST(Narx, GivesTheSameForTheSameSeed) {
  const Record record = saturating(800, 0.02, 6);
  const NarxFit first = fit_narx({.n = 1}, record.all());
  const NarxFit second = fit_narx({.n = 1}, record.all());
  ASSERT_TRUE(first.valid);
  EXPECT_EQ(first.x, second.x);
  EXPECT_NE(first.x, fit_narx({.n = 1, .seed = 2}, record.all()).x);
}

TEST(Narx, SaysWhyThereIsNoFit) {
  const Record record = saturating(60, 0.02, 6);
  EXPECT_EQ(fit_narx({}, record.all()).why, "too few samples");
}

}  // namespace
}  // namespace estimator::structures
