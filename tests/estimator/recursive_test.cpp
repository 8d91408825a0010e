#include "estimator/recursive.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "config/schema/error.h"
#include "estimator/batch.h"
#include "estimator/regressor.h"
#include "tests/estimator/data.h"

namespace estimator {
namespace {

using namespace testing_data;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void feed(Recursive& filter, const Data& data, int first = 0, int end = -1) {
  const int last = end < 0 ? static_cast<int>(data.u_V.size()) : end;
  for (int t = first; t < last; ++t) filter.push(data.u_V[t], data.y_m[t]);
}

/// Weighted least squares with the prior, computed afresh: rows sqrt(lambda^(T-t)) psi, and
/// theta / sqrt(C) as further rows.
struct Fresh {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;  // P
};
Fresh fresh(const RecursiveConfig& config, const Data& data) {
  Regressor regressor(config.structure);
  std::vector<double> rows;
  int count = 0;
  const int width = config.structure.size() + 1;
  for (std::size_t t = 0; t < data.u_V.size(); ++t) {
    if (!regressor.push(data.u_V[t], data.y_m[t])) continue;
    rows.insert(rows.end(), regressor.row(), regressor.row() + width);
    ++count;
  }
  const int p = width - 1;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(count + p, width);
  for (int i = 0; i < count; ++i) {
    const double weight = std::pow(config.forgetting, 0.5 * (count - 1 - i));
    for (int j = 0; j < width; ++j) a(i, j) = weight * rows[i * width + j];
  }
  for (int i = 0; i < p; ++i) {
    a(count + i, i) = std::pow(config.forgetting, 0.5 * count) / std::sqrt(config.prior_variance);
  }
  const Eigen::MatrixXd psi = a.leftCols(p);
  return {psi.householderQr().solve(a.col(p)), (psi.transpose() * psi).inverse()};
}

TEST(Recursive, EqualsTheRegularisedBatchSolutionWithoutForgetting) {
  const Data data = excited(3000, 1e-6, 1);
  // A small C makes the prior matter: theta and P must still be the closed form.
  for (const double prior : {1e2, 1e8}) {
    const RecursiveConfig config{.structure = kTruth, .prior_variance = prior, .limits = {}};
    Recursive filter(config);
    feed(filter, data);
    const Fresh expected = fresh(config, data);
    const Estimate ours = filter.estimate();
    ASSERT_TRUE(ours.valid);
    EXPECT_EQ(ours.samples, 2998);
    for (int i = 0; i < ours.size; ++i) {
      EXPECT_NEAR(ours.value[i], expected.theta[i], 1e-11);
      // The reported error is s sqrt(P_ii): the ratios between coefficients are those of P.
      EXPECT_NEAR(ours.std_error[i] / ours.std_error[0],
                  std::sqrt(expected.covariance(i, i) / expected.covariance(0, 0)), 1e-7);
    }
  }
}

TEST(Recursive, HasTheErrorsAndConditionOfTheBatchFitWithoutForgetting) {
  const Data data = excited(3000, 1e-6, 2);
  const Estimate batch = fit_batch(kTruth, data.u_V, data.y_m);
  Recursive filter({.structure = kTruth, .prior_variance = 1e12, .limits = {}});
  feed(filter, data);
  const Estimate ours = filter.estimate();
  for (int i = 0; i < ours.size; ++i) {
    // The prior pulls theta by P theta / C, here 3e-4 standard errors.
    EXPECT_NEAR(ours.value[i], batch.value[i], 1e-3 * batch.std_error[i]);
    EXPECT_NEAR(ours.std_error[i] / batch.std_error[i], 1.0, 1e-5);
  }
  EXPECT_NEAR(ours.condition / batch.condition, 1.0, 1e-5);
  EXPECT_NEAR(ours.residual_rms_m / batch.residual_rms_m, 1.0, 1e-5);
}

TEST(Recursive, ForgetsExponentially) {
  const Data data = excited(4000, 1e-6, 3);
  const RecursiveConfig config{.structure = kTruth, .forgetting = 0.98, .limits = {}};
  Recursive filter(config);
  feed(filter, data);
  const Fresh expected = fresh(config, data);
  const Estimate ours = filter.estimate();
  ASSERT_TRUE(ours.valid);
  EXPECT_EQ(ours.samples, 50);
  // The bound adds information of 1 / C = 1e-8 to some 1e-7: a small part of a standard error.
  for (int i = 0; i < ours.size; ++i) {
    EXPECT_NEAR(ours.value[i], expected.theta[i], 0.05 * ours.std_error[i]) << i;
  }
}

TEST(Recursive, ContinuesAWarmStartAsIfTheBatchHadGoneOn) {
  const Data data = excited(1000, 1e-6, 4);
  Recursive filter({.structure = kTruth, .warmup = 200, .limits = {}});
  feed(filter, data, 0, 201);
  EXPECT_EQ(filter.estimate().reason, Reason::too_short);
  EXPECT_TRUE(filter.push(data.u_V[201], data.y_m[201]));
  const auto expect_batch = [&](int end) {
    const Estimate ours = filter.estimate();
    const auto count = static_cast<std::size_t>(end);
    const Estimate batch =
        fit_batch(kTruth, std::span(data.u_V).first(count), std::span(data.y_m).first(count));
    ASSERT_TRUE(ours.valid);
    EXPECT_EQ(ours.samples, batch.samples);
    for (int i = 0; i < ours.size; ++i) {
      EXPECT_NEAR(ours.value[i], batch.value[i], 1e-8 * batch.std_error[i]);
      EXPECT_NEAR(ours.std_error[i] / batch.std_error[i], 1.0, 1e-9);
    }
    EXPECT_NEAR(ours.condition / batch.condition, 1.0, 1e-9);
  };
  expect_batch(202);
  feed(filter, data, 202);
  expect_batch(1000);
}

TEST(Recursive, StaysFiniteAndBoundedOverAMillionSamplesOfASineAndRecovers) {
  for (const double forgetting : {0.994, 0.98, 0.9}) {
    for (const double resolution_m : {0.0, 5e-6}) {
      const RecursiveConfig config{
          .structure = {4, 4, 1, false}, .forgetting = forgetting, .limits = {}};
      Recursive filter(config);
      Data sine = sine_loop(400 * 20, resolution_m);
      double largest = 0.0;
      for (int repeat = 0; repeat < 125; ++repeat) {
        for (std::size_t t = 4000; t < sine.u_V.size(); ++t) {
          filter.push(sine.u_V[t], sine.y_m[t]);
          filter.push(sine.u_V[t], sine.y_m[t] + resolution_m * static_cast<double>(t % 2));
        }
        for (int i = 0; i < 8; ++i) {
          largest = std::max(largest, std::abs(filter.coefficients()[i]));
        }
      }
      EXPECT_LT(largest, 100.0) << forgetting << " " << resolution_m;
      const Estimate wound = filter.estimate();
      EXPECT_NE(wound.reason, Reason::not_finite);
      for (int i = 0; i < 8; ++i) {
        // s sqrt(P_ii) with P at most C, give or take the turn over eight coefficients.
        EXPECT_LT(wound.std_error[i], 10.0 * wound.residual_rms_m * std::sqrt(1e8)) << i;
      }
      std::mt19937_64 random(5);
      const std::vector<double> theta{-1.5, 0.7, 0.1, -0.05, 0.2, -0.1, 0.3, 0.1};
      const std::vector<double> u_V = lcg(3000, 8);
      filter.gap();
      feed(filter, {u_V, simulate(config.structure, theta, u_V, 1e-4, random)});
      const Estimate after = filter.estimate();
      ASSERT_TRUE(after.valid) << to_string(after.reason);
      for (int i = 0; i < 8; ++i) {
        EXPECT_NEAR(after.value[i], theta[i], 6.0 * after.std_error[i]) << forgetting;
      }
    }
  }
}

TEST(Recursive, RecoversTheCoefficientsWithinThousandSamplesAfterALongSine) {
  Recursive filter({.structure = {2, 2, 1, false}, .forgetting = 0.98, .limits = {}});
  const Data sine = sine_loop(200'000, 5e-6);
  feed(filter, sine);
  std::mt19937_64 random(6);
  std::vector<double> u_V = lcg(1000, 8);
  const std::vector<double> theta{-1.5, 0.7, 2e-4, -1e-4};
  const Data rich{u_V, simulate({2, 2, 1, false}, theta, u_V, 1e-7, random)};
  filter.gap();
  feed(filter, rich);
  const Estimate after = filter.estimate();
  ASSERT_TRUE(after.valid);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(after.value[i], theta[i], 4.0 * after.std_error[i]);
  EXPECT_LT(after.std_error[0], 0.01);
}

TEST(Recursive, LearnsAndForgetsNothingWhileNothingMoves) {
  const Data data = excited(1000, 1e-6, 7);
  Recursive filter({.structure = kTruth, .forgetting = 0.99, .gate_window = 50, .limits = {}});
  feed(filter, data);
  for (int i = 0; i < 100; ++i) filter.push(0.5, 0.01);  // until both parts of the gate are still
  const Estimate before = filter.estimate();
  EXPECT_EQ(before.reason, Reason::not_excited);
  EXPECT_FALSE(before.valid);
  for (int i = 0; i < 100'000; ++i) EXPECT_FALSE(filter.push(0.5, 0.01));
  const Estimate after = filter.estimate();
  for (int i = 0; i < after.size; ++i) {
    EXPECT_EQ(after.value[i], before.value[i]);
    EXPECT_EQ(after.std_error[i], before.std_error[i]);
  }
  filter.gap();
  feed(filter, data);
  EXPECT_TRUE(filter.estimate().valid);
}

TEST(Recursive, IsNotExcitedBelowTheLimitsItIsGiven) {
  const Data data = excited(500, 1e-6, 8);
  Recursive filter({.structure = kTruth, .limits = {.min_span_y_m = 1.0}});
  feed(filter, data);
  EXPECT_EQ(filter.estimate().reason, Reason::not_excited);
}

TEST(Recursive, SkipsMissingAndImpossibleValues) {
  Data data = excited(2000, 1e-6, 9);
  Recursive clean({.structure = kTruth, .limits = {}});
  feed(clean, data);
  data.y_m[500] = kNan;
  data.u_V[800] = std::numeric_limits<double>::infinity();
  data.y_m[1200] = 1e200;
  Recursive filter({.structure = kTruth, .limits = {}});
  feed(filter, data);
  const Estimate ours = filter.estimate();
  const Estimate expected = clean.estimate();
  for (int i = 0; i < ours.size; ++i) EXPECT_TRUE(std::isfinite(ours.value[i]));
  for (int i = 0; i < ours.size; ++i) {
    EXPECT_NEAR(ours.value[i], expected.value[i], 1.0 * expected.std_error[i]);
  }
}

TEST(Recursive, StartsAgainAfterReset) {
  const Data data = excited(500, 1e-6, 10);
  Recursive filter({.structure = kTruth, .forgetting = 0.99, .warmup = 50, .limits = {}});
  feed(filter, data);
  const Estimate first = filter.estimate();
  filter.reset();
  EXPECT_EQ(filter.estimate().samples, 0);
  feed(filter, data);
  for (int i = 0; i < first.size; ++i) EXPECT_EQ(filter.estimate().value[i], first.value[i]);
}

TEST(Recursive, RefusesSettingsOutOfRange) {
  const auto refused = [](RecursiveConfig config) {
    config.structure = kTruth;
    EXPECT_THROW(Recursive{config}, config::schema::Error);
  };
  refused({.structure = {}, .forgetting = 0.0, .limits = {}});
  refused({.structure = {}, .forgetting = 1.001, .limits = {}});
  refused({.structure = {}, .forgetting = kNan, .limits = {}});
  refused({.structure = {}, .prior_variance = 0.0, .limits = {}});
  refused({.structure = {}, .warmup = 5, .limits = {}});
  refused({.structure = {}, .gate_window = 0, .limits = {}});
}

}  // namespace
}  // namespace estimator
