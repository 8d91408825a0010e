// The minimiser against certified answers and closed forms.
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

TEST(Minimize, CertifiedDataAreTypedInCorrectly) {
  for (const Certified& c : nist()) {
    MatrixXd r(c.problem.residuals, 1);
    c.problem.evaluate(c.value, r);
    EXPECT_NEAR(r.squaredNorm(), c.sum_of_squares, 1e-8 * c.sum_of_squares) << c.name;
  }
}

TEST(Minimize, ReachesTheCertifiedValuesFromBothStarts) {
  for (const bool central : {false, true}) {
    for (const Certified& c : nist()) {
      for (const VectorXd& start : c.starts) {
        MinimizeOptions options;
        options.max_iterations = 2000;
        options.central = central;
        options.cost_tolerance = 1e-14;
        Problem problem = c.problem;
        for (Unknown& unknown : problem.unknowns) unknown.relative_step = central ? 1e-5 : 1e-7;
        const Solution s = minimize(problem, start, options);
        // Forward differences leave the minimum by some 1e-7 of the curvature.
        const double tolerance = central ? 1e-6 : 1e-4;
        EXPECT_TRUE(s.converged) << c.name;
        EXPECT_NEAR(s.cost, c.sum_of_squares, 1e-8 * c.sum_of_squares) << c.name;
        for (Index j = 0; j < c.value.size(); ++j) {
          EXPECT_NEAR(s.x[j], c.value[j], tolerance * std::abs(c.value[j])) << c.name << j;
        }
        RecordProperty(c.name, s.evaluations);
      }
    }
  }
}

TEST(Minimize, SolvesALinearProblemInOneStepOfOneGroup) {
  Draw draw(1);
  const MatrixXd A = draw.matrix(200, 5);
  const VectorXd y = draw.matrix(200, 1);
  MinimizeOptions options;
  options.first_damping = 1e-12;
  options.cost_tolerance = 1e-12;
  const Solution s = minimize(linear(A, y), VectorXd::Zero(5), options);
  EXPECT_TRUE(s.x.isApprox(A.householderQr().solve(y), 1e-9));
  EXPECT_TRUE(s.jacobian.isApprox(-A, 1e-9));
  EXPECT_EQ(s.evaluations, 2);  // the start with its Jacobian, the solution with its own
}

TEST(Minimize, PriorsAreRidgeRegression) {
  Draw draw(2);
  const MatrixXd A = draw.matrix(50, 4);
  const VectorXd y = draw.matrix(50, 1);
  Problem problem = linear(A, y);
  problem.sigma = 0.3;
  const VectorXd mean = draw.matrix(4, 1);
  VectorXd precision = VectorXd::Zero(4);
  for (Index j = 0; j < 3; ++j) {
    problem.unknowns[static_cast<std::size_t>(j)].prior_mean = mean[j];
    problem.unknowns[static_cast<std::size_t>(j)].prior_sd = 0.05 * static_cast<double>(j + 1);
    precision[j] = std::pow(0.05 * static_cast<double>(j + 1), -2);
  }
  const MatrixXd P = precision.asDiagonal();
  const VectorXd expected =
      (A.transpose() * A / 0.09 + P).ldlt().solve(A.transpose() * y / 0.09 + P * mean);
  MinimizeOptions options;
  options.cost_tolerance = 1e-13;
  EXPECT_TRUE(minimize(problem, VectorXd::Zero(4), options).x.isApprox(expected, 1e-6));
}

TEST(Minimize, WeightsAreWeightedLeastSquaresAndZeroHidesNaN) {
  Draw draw(3);
  const MatrixXd A = draw.matrix(60, 3);
  VectorXd y = draw.matrix(60, 1);
  VectorXd w = draw.matrix(60, 1).cwiseAbs2();
  w.head(7).setZero();
  const VectorXd root = w.cwiseSqrt();
  const VectorXd expected =
      (root.asDiagonal() * A).eval().householderQr().solve((root.asDiagonal() * y).eval());
  y.head(7).setConstant(kNaN);
  Problem problem = linear(A, y);
  problem.weights = w;
  MinimizeOptions options;
  options.cost_tolerance = 1e-13;
  EXPECT_TRUE(minimize(problem, VectorXd::Ones(3), options).x.isApprox(expected, 1e-6));
}

// Every choice of active bounds solved in closed form; the best feasible one is the answer.
VectorXd best_in_box(const MatrixXd& A, const VectorXd& y, const VectorXd& low,
                     const VectorXd& high) {
  const Index p = A.cols();
  Index choices = 1;
  for (Index j = 0; j < p; ++j) choices *= 3;
  VectorXd best;
  double least = std::numeric_limits<double>::infinity();
  for (Index code = 0; code < choices; ++code) {
    VectorXd x = VectorXd::Zero(p);
    std::vector<Index> open;
    for (Index j = 0, rest = code; j < p; ++j, rest /= 3) {
      if (rest % 3 == 0) open.push_back(j);
      if (rest % 3 == 1) x[j] = low[j];
      if (rest % 3 == 2) x[j] = high[j];
    }
    if (!open.empty()) {
      MatrixXd F(A.rows(), static_cast<Index>(open.size()));
      for (std::size_t k = 0; k < open.size(); ++k) F.col(static_cast<Index>(k)) = A.col(open[k]);
      const VectorXd z = F.householderQr().solve((y - A * x).eval());
      for (std::size_t k = 0; k < open.size(); ++k) x[open[k]] = z[static_cast<Index>(k)];
    }
    if ((x.array() < low.array() - 1e-12).any() || (x.array() > high.array() + 1e-12).any()) {
      continue;
    }
    const double cost = (y - A * x).squaredNorm();
    if (cost < least) {
      least = cost;
      best = x;
    }
  }
  return best;
}

TEST(Minimize, BoundsGiveTheBestPointOfTheBox) {
  int at_bounds = 0;
  for (std::uint64_t seed = 10; seed < 60; ++seed) {
    Draw draw(seed);
    const Index p = 5;
    MatrixXd A = draw.matrix(30, p);
    A.col(1) = A.col(0) + 0.05 * A.col(1);  // nearly collinear
    const VectorXd y = 2.0 * draw.matrix(30, 1) + A * draw.matrix(p, 1);
    const VectorXd low = -draw.matrix(p, 1).cwiseAbs();
    const VectorXd high = draw.matrix(p, 1).cwiseAbs();
    Problem problem = linear(A, y);
    for (Index j = 0; j < p; ++j) {
      problem.unknowns[static_cast<std::size_t>(j)].lower = low[j];
      problem.unknowns[static_cast<std::size_t>(j)].upper = high[j];
      problem.unknowns[static_cast<std::size_t>(j)].step = 1e-4;
    }
    MinimizeOptions options;
    options.cost_tolerance = 1e-13;
    const Solution s = minimize(problem, VectorXd::Constant(p, 100.0), options);
    const VectorXd expected = best_in_box(A, y, low, high);
    EXPECT_LT((s.x - expected).norm(), 1e-5 * (1.0 + expected.norm())) << seed;
    for (Index j = 0; j < p; ++j) {
      const int side = expected[j] == high[j] ? 1 : expected[j] == low[j] ? -1 : 0;
      EXPECT_EQ(s.at_bound[static_cast<std::size_t>(j)], side) << seed << ' ' << j;
      at_bounds += side != 0;
    }
  }
  EXPECT_GT(at_bounds, 50);  // the draw did put the bounds to the test
}

TEST(Minimize, CostNeverRisesAndEveryPointAskedForIsInside) {
  const Certified c = nist()[5];  // Rat43, far start
  Problem problem = c.problem;
  const double lower[] = {50, 0.1, 0.1, 0.5};
  const double upper[] = {900, 12, 3, 4};
  for (std::size_t j = 0; j < 4; ++j) {
    problem.unknowns[j].lower = lower[j];
    problem.unknowns[j].upper = upper[j];
  }
  int outside = 0;
  problem.evaluate = [&](const MatrixXd& points, MatrixXd& r) {
    EXPECT_LE(points.cols(), 8);
    for (Index k = 0; k < points.cols(); ++k) {
      for (Index j = 0; j < 4; ++j) outside += points(j, k) < lower[j] || points(j, k) > upper[j];
    }
    c.problem.evaluate(points, r);
  };
  MinimizeOptions options;
  options.max_iterations = 500;
  double last = std::numeric_limits<double>::infinity();
  int calls = 0;
  options.progress = [&](const MinimizeProgress& progress) {
    EXPECT_LE(progress.cost, last);
    last = progress.cost;
    ++calls;
  };
  const Solution s = minimize(problem, c.starts[0], options);
  EXPECT_EQ(outside, 0);
  EXPECT_GT(calls, 3);
  EXPECT_NEAR(s.cost, c.sum_of_squares, 1e-6 * c.sum_of_squares);
}

TEST(Minimize, StepsAroundAPlaceWhereTheModelCannotBeEvaluated) {
  // r = log(x) - log(2), NaN below 0: the full step from 9 lands at a negative x.
  Problem problem;
  problem.residuals = 1;
  problem.unknowns.resize(1);
  problem.evaluate = [](const MatrixXd& points, MatrixXd& r) {
    for (Index k = 0; k < points.cols(); ++k) {
      r(0, k) = points(0, k) > 0 ? std::log(points(0, k) / 2.0) : kNaN;
    }
  };
  const Solution s = minimize(problem, VectorXd::Constant(1, 9.0));
  EXPECT_NEAR(s.x[0], 2.0, 1e-5);
  const Solution bad = minimize(problem, VectorXd::Constant(1, -1.0));
  EXPECT_FALSE(bad.converged);
  EXPECT_EQ(bad.reason, StopReason::start_not_finite);
  EXPECT_EQ(bad.x[0], -1.0);
}

TEST(Minimize, HeldUnknownsStayAndCostNoPoints) {
  Draw draw(4);
  const MatrixXd A = draw.matrix(40, 3);
  const VectorXd y = draw.matrix(40, 1);
  Problem problem = linear(A, y);
  problem.unknowns[1].lower = problem.unknowns[1].upper = 0.7;
  MinimizeOptions options;
  options.cost_tolerance = 1e-13;
  const Solution s = minimize(problem, VectorXd::Zero(3), options);
  MatrixXd rest(40, 2);
  rest << A.col(0), A.col(2);
  const VectorXd expected = rest.householderQr().solve((y - 0.7 * A.col(1)).eval());
  EXPECT_EQ(s.x[1], 0.7);
  EXPECT_NEAR(s.x[0], expected[0], 1e-6);
  EXPECT_NEAR(s.x[2], expected[1], 1e-6);
}

}  // namespace
}  // namespace estimator::nonlinear
