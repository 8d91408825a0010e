// Frequency responses of discrete systems whose transfer function is known.
#include "estimator/spectra/frequency_response.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace estimator::spectra {
namespace {

constexpr double kSampleTime_s = 0.005;
constexpr double kPole = 0.7;
constexpr double kGain = 0.5;
constexpr double kInput = 2.0;

struct Series {
  std::vector<double> u, y;
};

/// y(k) = 0.7 y(k-1) + 0.5 u(k-1) + noise(k), u white.
Series run(std::size_t n, double noise_sd, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Series s;
  double x = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    s.u.push_back(kInput * normal(random));
    s.y.push_back(x + noise_sd * normal(random));
    x = kPole * x + kGain * s.u.back();
  }
  return s;
}

std::complex<double> true_response(double f_Hz) {
  const std::complex<double> z = std::polar(1.0, 2.0 * std::numbers::pi * f_Hz * kSampleTime_s);
  return kGain / (z - kPole);
}

FrequencyResponse of(const Series& s, std::size_t window) {
  const Piece piece{s.u, s.y};
  return frequency_response(cross_spectra({&piece, 1}, kSampleTime_s, window));
}

TEST(FrequencyResponse, OfAKnownSystemIsItsTransferFunction) {
  const FrequencyResponse h = of(run(20000, 0.0, 1), 512);
  ASSERT_EQ(h.value.size(), 255U);
  for (std::size_t i = 0; i < h.value.size(); ++i) {
    const std::complex<double> truth = true_response(h.frequency_Hz[i]);
    // without noise the windows' ends alone differ: their share is the memory over the window
    EXPECT_NEAR(std::abs(h.value[i] / truth - 1.0), 0.0, 0.02);
    EXPECT_GT(h.coherence[i], 0.995);
  }
}

TEST(FrequencyResponse, HasTheCoherenceOfItsNoise) {
  constexpr double kNoise = 1.0;
  const FrequencyResponse h = of(run(400000, kNoise, 2), 256);
  for (std::size_t i = 5; i < h.value.size(); i += 10) {
    const double signal = std::norm(true_response(h.frequency_Hz[i])) * kInput * kInput;
    const double truth = signal / (signal + kNoise * kNoise);
    // standard error of a coherence: sqrt(2 c / n) (1 - c), Bendat and Piersol, table 9.6
    const double error = std::sqrt(2.0 * truth / h.averages) * (1.0 - truth);
    EXPECT_NEAR(h.coherence[i], truth, 4.0 * error + 0.002) << h.frequency_Hz[i];
  }
}

TEST(FrequencyResponse, ScattersByItsStandardError) {
  constexpr int kRuns = 300;
  constexpr std::size_t kWindow = 256;
  constexpr double kNoise = 2.0;
  const std::vector<std::size_t> places{4, 20, 60, 110};
  std::vector<double> squares(places.size(), 0.0);
  std::vector<double> phases(places.size(), 0.0);
  std::vector<double> stated(places.size(), 0.0);
  double averages = 0.0;
  for (unsigned seed = 0; seed < kRuns; ++seed) {
    const FrequencyResponse h = of(run(6000, kNoise, 100 + seed), kWindow);
    averages = h.averages;
    for (std::size_t p = 0; p < places.size(); ++p) {
      const std::complex<double> off =
          h.value[places[p]] / true_response(h.frequency_Hz[places[p]]);
      squares[p] += std::pow(std::abs(off) - 1.0, 2) / kRuns;
      phases[p] += std::pow(std::arg(off), 2) / kRuns;
      stated[p] += h.error_ratio[places[p]] / kRuns;
    }
  }
  for (std::size_t p = 0; p < places.size(); ++p) {
    const double f_Hz = static_cast<double>(places[p] + 1) / (kWindow * kSampleTime_s);
    const double signal = std::norm(true_response(f_Hz)) * kInput * kInput;
    const double c = signal / (signal + kNoise * kNoise);
    const double error = std::sqrt((1.0 - c) / (2.0 * averages * c));
    // the scatter of 300 runs is known to 4 %, the formula is of first order: four times and some
    EXPECT_NEAR(std::sqrt(squares[p]) / error, 1.0, 0.2) << f_Hz;
    EXPECT_NEAR(std::sqrt(phases[p]) / error, 1.0, 0.2) << f_Hz;
    EXPECT_NEAR(stated[p] / error, 1.0, 0.2) << f_Hz;
  }
}

TEST(FrequencyResponse, IsExcitedWhereTheInputIs) {
  // a sine of 12.5 Hz in the input, and noise in the output: nothing is known elsewhere
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  Series s;
  for (int k = 0; k < 8000; ++k) {
    const double sine = std::sin(2.0 * std::numbers::pi * 12.5 * kSampleTime_s * k);
    s.u.push_back(sine + 1e-6 * normal(random));
    s.y.push_back(3.0 * sine + 0.1 * normal(random));
  }
  const FrequencyResponse h = of(s, 512);
  const std::vector<bool> used = excited(h, 0.3);
  int beyond = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const bool near = std::abs(h.frequency_Hz[i] - 12.5) < 0.5;
    if (std::abs(h.frequency_Hz[i] - 12.5) < 0.01) {
      EXPECT_TRUE(used[i]);
      EXPECT_NEAR(std::abs(h.value[i]), 3.0, 0.02);
    }
    if (!near && used[i]) ++beyond;
  }
  EXPECT_LE(beyond, 3);  // one in a thousand of 250
}

}  // namespace
}  // namespace estimator::spectra
