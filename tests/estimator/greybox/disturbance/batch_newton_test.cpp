// Minima of functions whose minimum is known.
#include "estimator/greybox/disturbance/batch_newton.h"

#include <gtest/gtest.h>

#include <cmath>

namespace estimator::greybox::disturbance {
namespace {

constexpr double kEnough = 1e-4;
const SearchBounds kWide{SearchPoint::Constant(-10.0), SearchPoint::Constant(10.0)};

/// The function at each of the points, of which there are at most sixteen; counts its calls.
template <class F>
BatchFunction batch(const F& f, int* calls = nullptr) {
  return [=](const std::vector<SearchPoint>& points) {
    EXPECT_LE(points.size(), 16U);
    if (calls != nullptr) ++*calls;
    std::vector<double> values;
    for (const SearchPoint& point : points) values.push_back(f(point));
    return values;
  };
}

template <class F>
Minimum from(const SearchPoint& start, const F& f, const SearchBounds& bounds = kWide) {
  return minimise(batch(f), {start, f(start)}, bounds, kEnough);
}

/// A valley across the coordinates, 500 times as steep as it falls.
double valley(const SearchPoint& x) {
  return 500.0 * std::pow(x[0] - x[1], 2) + std::pow(x[0] + x[1] - 2.0, 2) +
         5.0 * std::pow(x[2] - 3.0, 2) + std::pow(x[3] + 1.0, 2) + 7.0;
}

TEST(BatchNewton, FollowsAValleyAcrossTheCoordinates) {
  const Minimum found = from(SearchPoint(-4.0, -4.0, 0.0, 4.0), valley);
  EXPECT_NEAR(found.value, 7.0, kEnough);
  EXPECT_LT((found.at - SearchPoint(1.0, 1.0, 3.0, -1.0)).cwiseAbs().maxCoeff(), 0.02);
}

TEST(BatchNewton, FindsAMinimumFromWhereTheFunctionIsFarFromSquare) {
  const auto f = [](const SearchPoint& x) {
    return 100.0 * ((x.array().exp() - x.array()).sum() - 4.0) + 20.0 * std::pow(x[0] - x[3], 2);
  };
  const Minimum found = from(SearchPoint(4.0, -6.0, 3.0, -5.0), f);
  // the last step gained more than kEnough, and each shrinks what is left
  EXPECT_NEAR(found.value, 0.0, 2.0 * kEnough);
  EXPECT_LT(found.at.cwiseAbs().maxCoeff(), 0.01);
}

TEST(BatchNewton, EndsAtABoundWithTheOthersAtTheirMinimumThere) {
  SearchBounds bounds = kWide;
  bounds.upper[0] = 0.5;
  const Minimum found = from(SearchPoint(-2.0, -2.0, 0.0, 0.0), valley, bounds);
  EXPECT_DOUBLE_EQ(found.at[0], 0.5);
  // the minimum of 500 (0.5 - x)^2 + (x - 1.5)^2
  EXPECT_NEAR(found.at[1], (250.0 + 1.5) / 501.0, 0.02);
  EXPECT_NEAR(found.at[2], 3.0, 0.02);
}

TEST(BatchNewton, GoesDownhillFromASaddle) {
  const auto f = [](const SearchPoint& x) {
    return std::pow(x[0] * x[0] - 1.0, 2) + x.tail<3>().squaredNorm();
  };
  const Minimum found = from(SearchPoint(0.2, 1.0, -1.0, 0.5), f);
  EXPECT_NEAR(std::abs(found.at[0]), 1.0, 0.02);
  EXPECT_NEAR(found.value, 0.0, 10.0 * kEnough);
}

TEST(BatchNewton, ComesToTheSameMinimumInFewerCallsLookingAhead) {
  const SearchPoint start(-4.0, -4.0, 0.0, 4.0);
  int plain_calls = 0;
  int calls = 0;
  const Minimum plain =
      minimise(batch(valley, &plain_calls), {start, valley(start)}, kWide, kEnough);
  const Minimum ahead =
      minimise(batch(valley, &calls), {start, valley(start)}, kWide, kEnough, Lookahead::yes);
  EXPECT_EQ(ahead.value, plain.value);
  EXPECT_EQ(ahead.at, plain.at);
  EXPECT_LT(calls, plain_calls);
}

}  // namespace
}  // namespace estimator::greybox::disturbance
