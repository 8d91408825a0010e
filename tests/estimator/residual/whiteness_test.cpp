// The residual tests under the null, whose p values must be uniform, and away from it.
#include "estimator/residual/whiteness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "estimator/residual/autoregression.h"
#include "estimator/residual/diebold_mariano.h"

namespace estimator::residual {
namespace {

using Series = std::vector<double>;

Series autoregressive(std::size_t n, double memory, std::mt19937_64& engine) {
  std::normal_distribution<double> draw;
  Series out(n);
  double e = draw(engine) / std::sqrt(1.0 - memory * memory);
  for (double& value : out) {
    value = e;
    e = memory * e + draw(engine);
  }
  return out;
}

/// Kolmogorov-Smirnov distance of p values from the uniform law.
double distance_from_uniform(Series p) {
  std::sort(p.begin(), p.end());
  double most = 0.0;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const auto n = static_cast<double>(p.size());
    most =
        std::max({most, p[k] - static_cast<double>(k) / n, static_cast<double>(k + 1) / n - p[k]});
  }
  return most;
}

constexpr int kRecords = 500;
const double kUniform = 1.63 / std::sqrt(kRecords);  // Kolmogorov-Smirnov, 1 %

TEST(Whiteness, IsUniformForWhiteNoiseAlsoWithGaps) {
  std::mt19937_64 engine(1);
  Series p;
  Series gaps;
  for (int k = 0; k < kRecords; ++k) {
    Series e = autoregressive(2000, 0.0, engine);
    p.push_back(whiteness(e).p);
    for (std::size_t t = 0; t < e.size(); ++t) {
      if (t / 200 % 2 == 1) e[t] = std::nan("");
    }
    gaps.push_back(whiteness(e).p);
  }
  EXPECT_LT(distance_from_uniform(p), kUniform);
  EXPECT_LT(distance_from_uniform(gaps), kUniform);
}

TEST(Whiteness, RejectsALittleMemory) {
  std::mt19937_64 engine(2);
  const TestResult found = whiteness(autoregressive(2000, 0.2, engine));
  EXPECT_LT(found.p, 1e-6);
  EXPECT_EQ(found.worst_lag, 1);
  EXPECT_NEAR(found.worst_correlation, 0.2, 0.07);
}

TEST(Whiteness, OfTooShortASeriesSaysNothing) {
  EXPECT_TRUE(std::isnan(whiteness(Series(50, 1.0)).p));
  EXPECT_EQ(whiteness(Series(500, 0.0)).p, 1.0);
}

struct Loop {
  Series u;
  Series e;
};

// A proportional controller on y = integral of u + e: every u carries the noise of its own sample.
// `missed`: part of the command that the model lacks and that is left in the residual.
Loop closed_loop(double memory, double missed, std::mt19937_64& engine) {
  std::normal_distribution<double> draw;
  const Series noise = autoregressive(3000, memory, engine);
  Loop out;
  double x = 0.0;
  double reference = 0.0;
  double last = 0.0;
  for (std::size_t t = 0; t < noise.size(); ++t) {
    if (t % 100 == 0) reference = 10.0 * draw(engine);
    out.e.push_back(noise[t] + missed * last);
    const double u = 0.3 * (reference - x - out.e.back());
    out.u.push_back(u);
    last = u;
    x += 0.5 * u;
  }
  return out;
}

TEST(Independence, IsUniformInClosedLoopForWhiteAndColouredNoise) {
  std::mt19937_64 engine(33);
  for (const double memory : {0.0, 0.7}) {
    Series p;
    for (int k = 0; k < kRecords; ++k) {
      const Loop loop = closed_loop(memory, 0.0, engine);
      p.push_back(independence(loop.e, loop.u).p);
    }
    EXPECT_LT(distance_from_uniform(p), kUniform) << memory;
  }
}

TEST(Independence, RejectsWhatTheModelMissedOfTheCommand) {
  std::mt19937_64 engine(4);
  int rejected = 0;
  for (int k = 0; k < 100; ++k) {
    const Loop loop = closed_loop(0.0, 0.2, engine);
    rejected += independence(loop.e, loop.u).p < 0.01;
  }
  EXPECT_GE(rejected, 95);
}

TEST(Independence, CopesWithASineAndWithNoInput) {
  std::mt19937_64 engine(5);
  const Series e = autoregressive(3000, 0.0, engine);
  Series u(e.size());
  for (std::size_t t = 0; t < u.size(); ++t) u[t] = std::sin(0.0157 * static_cast<double>(t));
  const TestResult found = independence(e, u);
  EXPECT_LE(found.dof, 3.0);
  EXPECT_GT(found.p, 1e-3);
  EXPECT_EQ(independence(e, Series(e.size(), 0.0)).p, 1.0);
}

TEST(Autoregression, FindsOrderCoefficientsAndEffectiveSamples) {
  std::mt19937_64 engine(6);
  const Series e = autoregressive(20000, 0.8, engine);
  const Autoregression model = fit_autoregression(e);
  ASSERT_EQ(model.a.size(), 1u);
  EXPECT_NEAR(model.a[0], 0.8, 0.02);
  EXPECT_NEAR(model.innovation_variance, 1.0, 0.04);
  // n (1 - rho) / (1 + rho)
  EXPECT_NEAR(model.effective_samples(), 20000.0 * 0.2 / 1.8, 300.0);
  EXPECT_TRUE(fit_autoregression(autoregressive(5000, 0.0, engine)).a.empty());
}

TEST(DieboldMariano, HasTheRightSizeAndPower) {
  std::mt19937_64 engine(7);
  int wrong = 0;
  int right = 0;
  for (int k = 0; k < kRecords; ++k) {
    const Series common = autoregressive(6000, 0.5, engine);
    const Series one = autoregressive(6000, 0.0, engine);
    const Series two = autoregressive(6000, 0.0, engine);
    Series first(common);
    Series second(common);
    Series worse(common);
    for (std::size_t t = 0; t < common.size(); ++t) {
      first[t] += 0.3 * one[t];
      second[t] += 0.3 * two[t];
      worse[t] += 0.5 * one[t];
      if (t / 400 % 2 == 0) first[t] = std::nan("");  // fitted blocks
    }
    wrong += diebold_mariano_test(first, second, 400).p < 0.05;
    const DieboldMarianoResult found = diebold_mariano_test(worse, second, 400);
    right += found.p < 0.05 && found.z > 0.0 && found.first_rms > found.second_rms;
    EXPECT_EQ(found.blocks, 15);
  }
  // Binomial(500, 0.05): 25 +- 4.9
  EXPECT_GT(wrong, 8);
  EXPECT_LT(wrong, 42);
  EXPECT_GT(right, kRecords * 95 / 100);
}

}  // namespace
}  // namespace estimator::residual
