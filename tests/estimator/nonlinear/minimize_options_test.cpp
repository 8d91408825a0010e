// How a search is told to go on, to stop, and what it is told beforehand.
#include "estimator/nonlinear/minimize.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "tests/estimator/nonlinear/problems.h"

namespace estimator::nonlinear {
namespace {

using namespace testing_problems;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(MinimizeOptions, CancelKeepsTheBestSoFar) {
  const Certified c = nist()[2];
  MinimizeOptions options;
  double reported = 0.0;
  int calls = 0;
  options.progress = [&](const MinimizeProgress& progress) {
    reported = progress.cost;
    ++calls;
  };
  options.cancel = [&] { return calls >= 3; };
  const Solution s = minimize(c.problem, c.starts[0], options);
  EXPECT_EQ(s.reason, StopReason::cancelled);
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(s.cost, reported);
  EXPECT_GT(s.cost, c.sum_of_squares);
}

// Twelve unknowns in a chain of saturating terms: more unknowns than lanes.
Problem twelve(VectorXd& truth) {
  Draw draw(5);
  const Index p = 12;
  const MatrixXd A = draw.matrix(6000, p);
  truth = draw.matrix(p, 1);
  const auto model = [A](const VectorXd& x) {
    return VectorXd((A * x).array() + 0.3 * (A.col(0) * x[1] + A.col(2) * x[3]).array().sin() +
                    0.2 * (A * x).array().tanh());
  };
  const VectorXd y = model(truth) + 0.01 * draw.matrix(6000, 1);
  Problem problem;
  problem.residuals = 6000;
  problem.unknowns.resize(static_cast<std::size_t>(p));
  for (Unknown& unknown : problem.unknowns) unknown.step = 1e-5;
  problem.sigma = 0.01;
  problem.evaluate = [=](const MatrixXd& points, MatrixXd& r) {
    for (Index k = 0; k < points.cols(); ++k) r.col(k) = y - model(points.col(k));
  };
  return problem;
}

TEST(MinimizeOptions, BroydenForTheColumnsThatDoNotFitReachesTheSameMinimum) {
  VectorXd truth;
  const Problem problem = twelve(truth);
  MinimizeOptions all;
  MinimizeOptions some;
  some.renew_all = false;
  const Solution a = minimize(problem, VectorXd::Zero(12), all);
  const Solution b = minimize(problem, VectorXd::Zero(12), some);
  EXPECT_LT((a.x - truth).norm(), 0.01);
  EXPECT_LT((a.x - b.x).norm(), 1e-5);
  EXPECT_NEAR(a.cost, b.cost, 1e-6 * a.cost);
  EXPECT_LT(b.evaluations, a.evaluations + 1);
  // Both leave a Jacobian that was evaluated at the solution.
  EXPECT_TRUE(a.jacobian.isApprox(b.jacobian, 1e-3));
}

TEST(MinimizeOptions, KnownStartSavesItsEvaluation) {
  VectorXd truth;
  const Problem problem = twelve(truth);
  const Solution first = minimize(problem, VectorXd::Zero(12));
  MinimizeOptions options;
  options.start_residual = first.residual;
  options.start_jacobian = first.jacobian;
  const Solution again = minimize(problem, first.x, options);
  EXPECT_EQ(again.evaluations, 0);
  EXPECT_TRUE(again.converged);
  EXPECT_EQ(again.cost, first.cost);
  options.start_jacobian.col(4).setConstant(kNaN);
  EXPECT_EQ(minimize(problem, first.x, options).evaluations, 1);
}

}  // namespace
}  // namespace estimator::nonlinear
