// Averaged spectra against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "estimator/spectra/cross_spectra.h"

namespace estimator::spectra {
namespace {

constexpr double kSampleTime_s = 0.005;

CrossSpectra of(const std::vector<double>& x, std::size_t window) {
  const Piece piece{x, x};
  return cross_spectra({&piece, 1}, kSampleTime_s, window);
}

double integral(const CrossSpectra& s, double from_Hz, double to_Hz) {
  double sum = 0.0;
  for (std::size_t i = 0; i < s.frequency_Hz.size(); ++i) {
    if (s.frequency_Hz[i] >= from_Hz && s.frequency_Hz[i] <= to_Hz) sum += s.input[i];
  }
  return sum * (s.frequency_Hz[1] - s.frequency_Hz[0]);
}

TEST(Spectrum, OfWhiteNoiseIsFlatAtTwiceItsVarianceTimesTheSampleTime) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 3.0);
  std::vector<double> x(1 << 16);
  for (double& value : x) value = noise(random);
  const CrossSpectra s = of(x, 256);
  EXPECT_EQ(s.frequency_Hz.size(), 127U);
  EXPECT_DOUBLE_EQ(s.frequency_Hz.front(), 200.0 / 256.0);
  const double level = 2.0 * 9.0 * kSampleTime_s;
  const double mean = std::accumulate(s.input.begin(), s.input.end(), 0.0) / 127.0;
  EXPECT_NEAR(mean, level, 0.02 * level);  // 65536 samples: 0.6 % standard error
  // a point varies by 1 / sqrt(averages): five of these
  for (const double density : s.input) {
    EXPECT_NEAR(density, level, 5.0 * level / std::sqrt(s.averages));
  }
}

TEST(Spectrum, OfASineHoldsHalfItsAmplitudeSquared) {
  std::vector<double> x(8192);
  for (std::size_t k = 0; k < x.size(); ++k) {
    x[k] = 7.0 + 0.4 * std::sin(2.0 * std::numbers::pi * 23.3 * kSampleTime_s * double(k));
  }
  const CrossSpectra s = of(x, 1024);
  EXPECT_NEAR(integral(s, 20.0, 27.0), 0.5 * 0.4 * 0.4, 1e-3 * 0.08);  // the sidelobes beyond
  EXPECT_LT(integral(s, 30.0, 99.0), 1e-6);
}

TEST(Spectrum, CountsOverlappingWindowsAsFewer) {
  const std::vector<double> x(1024 + 9 * 512, 1.0);  // ten windows
  EXPECT_NEAR(of(x, 1024).averages, 10.0 / (1.0 + 1.8 / 36.0), 1e-12);
  EXPECT_TRUE(of(std::vector<double>(1000, 1.0), 1024).empty());
}

TEST(Spectrum, TakesNoWindowAcrossPieces) {
  const std::vector<double> low(512, 0.0);
  const std::vector<double> high(512, 1.0);
  const Piece pieces[] = {{low, low}, {high, high}};
  const CrossSpectra s = cross_spectra(pieces, kSampleTime_s, 256);
  for (const double density : s.input) EXPECT_LT(density, 1e-25);  // a step would be everywhere
}

TEST(Spectrum, ChoosesAWindowThatLeavesEightAverages) {
  EXPECT_EQ(window_for(100, kSampleTime_s), 0U);
  for (const std::size_t n : {128U, 1000U, 6000U, 20000U}) {
    const std::size_t window = window_for(n, kSampleTime_s);
    EXPECT_GE((n - window) / (window / 2) + 1, 8U) << n;
  }
  EXPECT_LE(static_cast<double>(window_for(1'000'000, kSampleTime_s)) * kSampleTime_s, 8.0);
}

}  // namespace
}  // namespace estimator::spectra
