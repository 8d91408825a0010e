// Parameters that a record cannot see, and how far a likelihood reaches, against closed forms.
#include "estimator/nonlinear/identifiability.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "estimator/nonlinear/profile.h"
#include "tests/estimator/nonlinear/problems.h"

namespace estimator::nonlinear {
namespace {

using namespace testing_problems;

// y = gain sqrt(Ps) u in logarithms, with a third parameter of its own and a fourth without effect.
Problem supply(VectorXd& centre) {
  Problem problem;
  problem.residuals = 300;
  problem.unknowns.resize(4);
  problem.sigma = 1e-3;
  for (Unknown& unknown : problem.unknowns) unknown.step = 1e-6;
  centre = VectorXd::Zero(4);
  problem.evaluate = [](const MatrixXd& points, MatrixXd& r) {
    for (Index k = 0; k < points.cols(); ++k) {
      for (Index i = 0; i < 300; ++i) {
        const double t = 0.02 * static_cast<double>(i);
        const double slope = std::exp(points(0, k) + 0.5 * points(1, k));
        r(i, k) = std::sin(3.0 * t) - slope * std::sin(3.0 * t) - points(2, k) * std::cos(t);
      }
    }
  };
  return problem;
}

TEST(Identifiability, OnlyGainTimesRootOfSupplyIsVisible) {
  VectorXd centre;
  Problem problem = supply(centre);
  const Solution s = minimize(problem, centre);
  const Identifiability found = identifiability(problem, s.jacobian, VectorXd::Ones(4));
  ASSERT_EQ(found.unseen.size(), 2u);
  const Combination* pair = nullptr;
  const Combination* single = nullptr;
  for (const Combination& c : found.unseen) (c.terms.size() == 2 ? pair : single) = &c;
  ASSERT_NE(pair, nullptr);
  ASSERT_NE(single, nullptr);
  EXPECT_EQ(single->terms[0].unknown, 3);
  EXPECT_EQ(pair->terms[0].unknown, 1);
  EXPECT_NEAR(pair->terms[0].weight, 2.0 / std::sqrt(5.0), 1e-3);
  EXPECT_EQ(pair->terms[1].unknown, 0);
  EXPECT_NEAR(pair->terms[1].weight, -1.0 / std::sqrt(5.0), 1e-3);
  EXPECT_GT(pair->uncertainty, 10.0);
  // visible: gain + 0.5 ln Ps
  ASSERT_EQ(pair->visible.size(), 2u);
  EXPECT_NEAR(pair->visible[0].weight / pair->visible[1].weight, 0.5, 1e-3);
  // sin 3t has 300/2 of energy: alone sigma / sqrt(150)
  EXPECT_NEAR(found.alone[0], 1e-3 / std::sqrt(150.0), 3e-6);
  EXPECT_GT(found.together[0], 10.0);
  EXPECT_LT(found.together[2], 1e-3);

  // A prior on the pressure makes the gain known.
  problem.unknowns[1].prior_mean = 0.0;
  problem.unknowns[1].prior_sd = 0.01;
  IdentifiabilityOptions options;
  options.with_priors = true;
  const Identifiability helped = identifiability(problem, s.jacobian, VectorXd::Ones(4), options);
  EXPECT_EQ(helped.unseen.size(), 1u);
  EXPECT_NEAR(helped.together[0], 0.005, 1e-4);
}

TEST(Profile, OfALinearProblemIsTheNormalInterval) {
  Draw draw(5);
  const MatrixXd A = draw.matrix(100, 4);
  Problem problem = linear(A, draw.matrix(100, 1));
  const Solution s = minimize(problem, VectorXd::Zero(4));
  const double error = std::sqrt((A.transpose() * A).inverse()(2, 2));
  const Profile p = profile(problem, s, 2);
  EXPECT_TRUE(p.low_found && p.high_found);
  EXPECT_NEAR(p.low, s.x[2] - 1.96 * error, 0.05 * error);
  EXPECT_NEAR(p.high, s.x[2] + 1.96 * error, 0.05 * error);
  ProfileOptions four;
  four.inflation = 4.0;
  EXPECT_NEAR(profile(problem, s, 2, four).high, s.x[2] + 3.92 * error, 0.1 * error);
}

TEST(Profile, SaysOneSidedAndFlat) {
  // r = y - exp(-a t) with data that have died out at once: any large a will do.
  Problem problem;
  problem.residuals = 50;
  problem.sigma = 0.1;
  problem.unknowns.resize(2);
  problem.unknowns[0].lower = 0.0;
  problem.unknowns[0].upper = 200.0;
  problem.unknowns[0].step = 1e-4;
  problem.unknowns[1].lower = -1.0;
  problem.unknowns[1].upper = 1.0;
  problem.evaluate = [](const MatrixXd& points, MatrixXd& r) {
    for (Index k = 0; k < points.cols(); ++k) {
      for (Index i = 0; i < 50; ++i) r(i, k) = -std::exp(-points(0, k) * (0.1 + 0.02 * double(i)));
    }
  };
  VectorXd start(2);
  start << 60.0, 0.3;
  const Solution s = minimize(problem, start);
  const Profile rate = profile(problem, s, 0);
  EXPECT_TRUE(rate.low_found);
  EXPECT_FALSE(rate.high_found);
  EXPECT_EQ(rate.high, 200.0);
  // sum exp(-2 a t) = 3.84 sigma^2 at the limit
  double sum = 0.0;
  for (int i = 0; i < 50; ++i) sum += std::exp(-2.0 * rate.low * (0.1 + 0.02 * i));
  EXPECT_NEAR(sum / 0.01, 3.84, 0.2);
  const Profile nothing = profile(problem, s, 1);
  EXPECT_FALSE(nothing.low_found);
  EXPECT_FALSE(nothing.high_found);
  EXPECT_EQ(nothing.low, -1.0);
  EXPECT_EQ(nothing.high, 1.0);
}

}  // namespace
}  // namespace estimator::nonlinear
