// The remainder of a residual, beside a dense least-squares solution of the same sum.
#include "estimator/greybox/selection/projection.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>

namespace estimator::greybox::selection {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kSamples = 240;
constexpr double kNoPrior = std::numeric_limits<double>::infinity();

/// Three parameters, the last without a prior; numbers that are the same everywhere.
greybox::FitSummary example() {
  greybox::FitSummary fitted;
  for (const double sd : {0.02, 0.3, kNoPrior}) {
    greybox::FreeParameter p;
    p.prior_sd = sd;
    p.prior_mean = std::isfinite(sd) ? 0.7 * sd : 0.0;
    fitted.parameters.push_back(p);
  }
  fitted.theta = VectorXd::Constant(3, 0.01);
  fitted.sigma_m = 3e-6;
  std::srand(3);
  fitted.jacobian = 1e-5 * MatrixXd::Random(kSamples, 3);
  fitted.residual_m = 1e-5 * VectorXd::Random(kSamples);
  return fitted;
}

VectorXd every_third_left_out() {
  VectorXd weights = VectorXd::Ones(kSamples);
  for (Index k = 0; k < kSamples; k += 3) weights[k] = 0.0;
  return weights;
}

struct Dense {
  double cost;
  VectorXd solution;
};

/// The sum of the header with further columns, as one tall least-squares problem.
Dense dense(const greybox::FitSummary& fitted, const VectorXd& weights, const VectorXd& residual_m,
            const VectorXd& theta, const MatrixXd& signatures_m) {
  const Index parameters = fitted.jacobian.cols();
  MatrixXd a = MatrixXd::Zero(kSamples + parameters, parameters + signatures_m.cols());
  a.topLeftCorner(kSamples, parameters) = weights.asDiagonal() * fitted.jacobian / fitted.sigma_m;
  a.topRightCorner(kSamples, signatures_m.cols()) =
      weights.asDiagonal() * signatures_m / fitted.sigma_m;
  for (Index i = 0; i < parameters; ++i) {
    a(kSamples + i, i) = 1.0 / fitted.parameters[static_cast<std::size_t>(i)].prior_sd;
  }
  VectorXd b = VectorXd::Zero(kSamples + parameters);
  for (Index i = 0; i < parameters; ++i) {
    const greybox::FreeParameter& p = fitted.parameters[static_cast<std::size_t>(i)];
    b[kSamples + i] = (p.prior_mean - theta[i]) / p.prior_sd;
  }
  b.head(kSamples) = -weights.cwiseProduct(residual_m) / fitted.sigma_m;
  const VectorXd solution = a.colPivHouseholderQr().solve(b);
  return {(a * solution - b).squaredNorm(), solution};
}

TEST(Projection, LeavesWhatTheParametersCannotTakeAwayWithinTheirPriors) {
  const greybox::FitSummary fitted = example();
  const VectorXd weights = every_third_left_out();
  const Projection projection(fitted, weights);
  const Dense expected =
      dense(fitted, weights, fitted.residual_m, fitted.theta, MatrixXd(kSamples, 0));
  EXPECT_NEAR(projection.cost(), expected.cost, 1e-9 * expected.cost);
}

TEST(Projection, FindsTheStrengthOfASignatureBesideAdjustingParameters) {
  const greybox::FitSummary fitted = example();
  const VectorXd weights = every_third_left_out();
  const Projection projection(fitted, weights);
  const VectorXd residual_m = fitted.residual_m + 2e-6 * VectorXd::Random(kSamples);
  const VectorXd signature_m = 4e-6 * VectorXd::Random(kSamples) + fitted.jacobian.col(1);
  const VectorXd theta{{0.03, -0.2, 5.0}};
  const auto [cost, strength] = projection.with(residual_m, theta, signature_m);
  const Dense expected = dense(fitted, weights, residual_m, theta, signature_m);
  EXPECT_NEAR(cost, expected.cost, 1e-9 * expected.cost);
  EXPECT_NEAR(strength, expected.solution[3], 1e-9);
}

TEST(Projection, FindsTwoStrengthsTogether) {
  const greybox::FitSummary fitted = example();
  const VectorXd weights = every_third_left_out();
  const Projection projection(fitted, weights);
  MatrixXd both_m = 4e-6 * MatrixXd::Random(kSamples, 2);
  both_m.col(1) += 0.7 * both_m.col(0);
  const Projection::Two two =
      projection.with(fitted.residual_m, fitted.theta, both_m.col(0), both_m.col(1));
  const Dense expected = dense(fitted, weights, fitted.residual_m, fitted.theta, both_m);
  EXPECT_NEAR(two.cost, expected.cost, 1e-9 * expected.cost);
  EXPECT_NEAR(two.first, expected.solution[3], 1e-9);
  EXPECT_NEAR(two.second, expected.solution[4], 1e-9);
}

TEST(Projection, GivesNoStrengthToASignatureThatCannotBeTold) {
  const greybox::FitSummary fitted = example();
  const Projection projection(fitted, every_third_left_out());
  const auto [cost, strength] =
      projection.with(fitted.residual_m, fitted.theta, VectorXd::Zero(kSamples));
  EXPECT_DOUBLE_EQ(cost, projection.cost());
  EXPECT_EQ(strength, 0.0);
  const VectorXd signature_m = 1e-6 * VectorXd::Random(kSamples);
  const Projection::Two two =
      projection.with(fitted.residual_m, fitted.theta, signature_m, 2.0 * signature_m);
  EXPECT_EQ(two.first, 0.0);
  EXPECT_EQ(two.second, 0.0);
}

TEST(Projection, TakesFromASignatureWhatTheParametersCanImitate) {
  greybox::FitSummary fitted = example();
  for (greybox::FreeParameter& p : fitted.parameters) p.prior_sd = kNoPrior;
  const Projection projection(fitted, VectorXd::Ones(kSamples));
  const VectorXd own_m = 1e-6 * VectorXd::Random(kSamples);
  const VectorXd beyond_m = projection.beyond(own_m + 0.4 * fitted.jacobian.col(0));
  EXPECT_LT((fitted.jacobian.transpose() * beyond_m).norm(), 1e-6 * fitted.jacobian.norm() * 1e-6);
  const VectorXd c = fitted.jacobian.colPivHouseholderQr().solve(own_m);
  EXPECT_LT((beyond_m - (own_m - fitted.jacobian * c)).norm(), 1e-12);
}

}  // namespace
}  // namespace estimator::greybox::selection
