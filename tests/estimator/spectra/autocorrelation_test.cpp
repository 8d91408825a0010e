#include "estimator/spectra/autocorrelation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace estimator::spectra {
namespace {

TEST(Autocorrelation, OfAFirstOrderProcessFallsByItsFactor) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise;
  std::vector<double> x{0.0};
  for (int k = 0; k < 40000; ++k) x.push_back(0.8 * x.back() + noise(random));
  const Autocorrelation r = autocorrelation(x, 10);
  ASSERT_EQ(r.value.size(), 11U);
  EXPECT_DOUBLE_EQ(r.value[0], 1.0);
  // Bartlett: the standard error at high lags is sqrt((1 + a^2) / (1 - a^2) / n) = 0.011
  for (std::size_t lag = 1; lag <= 10; ++lag) {
    EXPECT_NEAR(r.value[lag], std::pow(0.8, static_cast<double>(lag)), 4.0 * 0.011);
  }
}

TEST(Autocorrelation, OfWhiteNoiseStaysWithinItsBound) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  std::vector<double> x(5000);
  for (double& value : x) value = noise(random);
  const Autocorrelation r = autocorrelation(x, 200);
  EXPECT_NEAR(r.white_bound, 1.96 / std::sqrt(5000.0), 1e-12);
  int beyond = 0;
  for (std::size_t lag = 1; lag <= 200; ++lag) beyond += std::abs(r.value[lag]) > r.white_bound;
  EXPECT_LE(beyond, 22);  // 5 % of 200, and four standard deviations of that number
}

TEST(Autocorrelation, LeavesMissingSamplesOut) {
  std::vector<double> x;
  for (int k = 0; k < 1000; ++k) x.push_back(k % 2 == 0 ? 1.0 : -1.0);
  for (const std::size_t k : {10U, 500U, 501U}) x[k] = std::nan("");
  const Autocorrelation r = autocorrelation(x, 2);
  EXPECT_NEAR(r.value[1], -1.0, 0.01);
  EXPECT_NEAR(r.value[2], 1.0, 0.01);
}

}  // namespace
}  // namespace estimator::spectra
