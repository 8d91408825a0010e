// Reported errors against closed forms, certified values, and the errors really made.
#include "estimator/nonlinear/covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "tests/estimator/nonlinear/problems.h"

namespace estimator::nonlinear {
namespace {

using namespace testing_problems;

MatrixXd normal(Index rows, Index columns, std::mt19937_64& engine) {
  std::normal_distribution<double> draw;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return draw(engine); });
}

/// Slow sensitivities, as a position's are.
MatrixXd slow(Index n) {
  MatrixXd A(n, 4);
  for (Index i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(n);
    A.row(i) << 1.0, std::sin(40.0 * t), std::cos(93.0 * t), std::sin(7.0 * t) * t;
  }
  return A;
}

TEST(Covariance, WhiteLinearCaseIsTheClosedForm) {
  std::mt19937_64 engine(1);
  const MatrixXd A = normal(80, 3, engine);
  Problem problem = linear(A, normal(80, 1, engine));
  problem.sigma = 0.7;
  problem.unknowns[0].prior_mean = 0.2;
  problem.unknowns[0].prior_sd = 0.1;
  CovarianceOptions options;
  options.colour = Colour::white;
  options.noise_sd = 0.7;
  const Covariance c = covariance(problem, minimize(problem, VectorXd::Zero(3)), options);
  MatrixXd H = A.transpose() * A / 0.49;
  H(0, 0) += 100.0;
  EXPECT_TRUE(c.matrix.isApprox(H.inverse(), 1e-6));
  EXPECT_NEAR(c.inflation[1], 1.0, 1e-6);
}

TEST(Covariance, SeriesHaveTheNoiseOfTheirOwn) {
  constexpr Index kRows = 4000;
  constexpr double kFirst = 0.5;
  constexpr double kSecond = 3.0;
  std::mt19937_64 engine(2);
  const MatrixXd A = normal(2 * kRows, 3, engine);
  MatrixXd y = normal(2 * kRows, 1, engine);
  y.topRows(kRows) *= kFirst;
  y.bottomRows(kRows) *= kSecond;
  const Problem problem = linear(A, y);
  CovarianceOptions options;
  options.series = {kRows};
  const Solution solution = minimize(problem, VectorXd::Zero(3));
  const MatrixXd first = A.topRows(kRows);
  const MatrixXd second = A.bottomRows(kRows);
  const MatrixXd middle =
      kFirst * kFirst * first.transpose() * first + kSecond * kSecond * second.transpose() * second;
  const MatrixXd inverse = (A.transpose() * A).inverse();
  const VectorXd expected = (inverse * middle * inverse).diagonal().cwiseSqrt();
  for (const Colour colour : {Colour::white, Colour::coloured}) {
    options.colour = colour;
    const Covariance found = covariance(problem, solution, options);
    // The noise of 4000 numbers is known to 1.1 %; what looks like colour in them adds to that.
    for (Index j = 0; j < 3; ++j) EXPECT_NEAR(found.std_error[j], expected[j], 0.06 * expected[j]);
    const double both = std::sqrt(0.5 * (kFirst * kFirst + kSecond * kSecond));
    EXPECT_NEAR(found.noise_sd, both, 0.04 * both);
  }
}

TEST(Covariance, ASeriesOfItsOwnDoesNotTakeTheOthersColour) {
  // Slow noise behind white noise: each parameter is seen in one of them alone.
  constexpr Index kRows = 4000;
  constexpr double kMemory = 0.9;
  std::mt19937_64 engine(3);
  MatrixXd A = MatrixXd::Zero(2 * kRows, 2);
  A.topRows(kRows).col(0).setOnes();
  A.bottomRows(kRows).col(1).setOnes();
  MatrixXd y = normal(2 * kRows, 1, engine);
  for (Index i = kRows + 1; i < 2 * kRows; ++i) y(i, 0) += kMemory * y(i - 1, 0);
  const Problem problem = linear(A, y);
  CovarianceOptions options;
  options.series = {kRows};
  const Covariance found = covariance(problem, minimize(problem, VectorXd::Zero(2)), options);
  // Standard error of the mean of n numbers: 1 / sqrt n; with the memory a, 1 / ((1 - a) sqrt n).
  const double white = 1.0 / std::sqrt(static_cast<double>(kRows));
  EXPECT_NEAR(found.std_error[0], white, 0.15 * white);
  EXPECT_NEAR(found.std_error[1], white / (1.0 - kMemory), 0.25 * white / (1.0 - kMemory));
}

TEST(Covariance, StandardDeviationsAreTheCertifiedOnes) {
  int compared = 0;
  for (const Certified& c : nist()) {
    if (c.standard_deviation.size() == 0) continue;
    MinimizeOptions search;
    search.max_iterations = 1000;
    search.cost_tolerance = 1e-14;
    search.central = true;
    Problem problem = c.problem;
    for (Unknown& unknown : problem.unknowns) unknown.relative_step = 1e-5;
    CovarianceOptions options;
    options.colour = Colour::white;
    const Covariance found =
        covariance(problem, minimize(problem, c.starts.back(), search), options);
    for (Index j = 0; j < c.value.size(); ++j) {
      EXPECT_NEAR(found.std_error[j], c.standard_deviation[j], 1e-4 * c.standard_deviation[j])
          << c.name << j;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 13);
}

TEST(Covariance, UnknownsAtABoundAreFlaggedAndTheOthersAreGivenThatBound) {
  std::mt19937_64 engine(2);
  const MatrixXd A = normal(60, 3, engine);
  Problem problem = linear(A, A * VectorXd::Constant(3, 1.0) + normal(60, 1, engine));
  problem.unknowns[1].upper = 0.0;
  problem.unknowns[1].step = 1e-3;
  CovarianceOptions options;
  options.colour = Colour::white;
  options.noise_sd = 1.0;
  const Covariance c = covariance(problem, minimize(problem, VectorXd::Zero(3)), options);
  EXPECT_EQ(c.standing[1], Standing::at_bound);
  EXPECT_TRUE(std::isnan(c.std_error[1]));
  MatrixXd rest(60, 2);
  rest << A.col(0), A.col(2);
  const MatrixXd expected = (rest.transpose() * rest).inverse();
  EXPECT_NEAR(c.std_error[0], std::sqrt(expected(0, 0)), 1e-6);
  EXPECT_NEAR(c.matrix(0, 2), expected(0, 1), 1e-6);
}

TEST(Covariance, WhatNobodySeesHasAnInfiniteError) {
  std::mt19937_64 engine(3);
  MatrixXd A = normal(60, 3, engine);
  A.col(2) = 2.0 * A.col(1);
  const Problem problem = linear(A, normal(60, 1, engine));
  const Covariance c = covariance(problem, minimize(problem, VectorXd::Zero(3)));
  EXPECT_EQ(c.standing[0], Standing::estimated);
  EXPECT_EQ(c.standing[1], Standing::unseen);
  EXPECT_TRUE(std::isinf(c.std_error[2]));
  EXPECT_GT(c.std_error[0], 0.0);
}

struct Coverage {
  double share[4] = {};
};

Coverage coverage(Colour colour, double memory, bool masked) {
  constexpr int kRecords = 400;
  constexpr Index kSamples = 2000;
  const MatrixXd A = slow(kSamples);
  const VectorXd truth = VectorXd::LinSpaced(4, -1.0, 2.0);
  Coverage out;
  std::mt19937_64 engine(77);
  std::normal_distribution<double> draw;
  for (int record = 0; record < kRecords; ++record) {
    VectorXd y = A * truth;
    double e = draw(engine) / std::sqrt(1.0 - memory * memory);
    for (Index i = 0; i < kSamples; ++i) {
      y[i] += 0.1 * e;
      e = memory * e + draw(engine);
    }
    Problem problem = linear(A, y);
    if (masked) {
      problem.weights = VectorXd::Ones(kSamples);
      for (Index i = 0; i < kSamples; ++i) problem.weights[i] = (i / 300) % 2 == 0 ? 1.0 : 0.0;
    }
    Solution s;  // the linear minimum, without the search
    const MatrixXd W = masked ? MatrixXd(problem.weights.asDiagonal() * A) : A;
    s.x = (W.transpose() * A).ldlt().solve(W.transpose() * y);
    s.residual = y - A * s.x;
    s.jacobian = -A;
    s.at_bound.assign(4, 0);
    CovarianceOptions options;
    options.colour = colour;
    const Covariance c = covariance(problem, s, options);
    for (Index j = 0; j < 4; ++j) {
      out.share[j] += (c.low[j] <= truth[j] && truth[j] <= c.high[j]) / double{kRecords};
    }
  }
  return out;
}

TEST(Covariance, IntervalsCoverTheTruthUnderColouredNoise) {
  for (const double memory : {0.0, 0.5, 0.9}) {
    for (const bool masked : {false, true}) {
      const Coverage c = coverage(Colour::coloured, memory, masked);
      for (const double share : c.share) {
        EXPECT_GE(share, 0.90) << memory << masked;  // the aim is 90 to 99 %
        EXPECT_LE(share, 0.99) << memory << masked;
      }
    }
  }
}

TEST(Covariance, IntervalsFromTheScoresCoverTheTruth) {
  for (const double memory : {0.0, 0.5}) {
    const Coverage c = coverage(Colour::scores, memory, false);
    for (const double share : c.share) {
      EXPECT_GE(share, 0.90) << memory;
      EXPECT_LE(share, 0.99) << memory;
    }
  }
}

TEST(Covariance, TakingColourForWhiteWouldNotCover) {
  EXPECT_LT(coverage(Colour::white, 0.9, false).share[0], 0.6);
}

}  // namespace
}  // namespace estimator::nonlinear
