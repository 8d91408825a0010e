// Resonances of responses that are written down, with noise of the size that they state.
#include "estimator/spectra/resonance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace estimator::spectra {
namespace {

using Complex = std::complex<double>;

constexpr double kFrequency_Hz = 34.0;
constexpr double kDamping = 0.03;
constexpr double kError = 0.05;

/// 1 / (1 + 2 d s + s^2) in s = i f / f0.
Complex ringing(double f_Hz, double damping = kDamping) {
  const Complex s(0.0, f_Hz / kFrequency_Hz);
  return 1.0 / (1.0 + 2.0 * damping * s + s * s);
}

template <class F>
FrequencyResponse response(F of_Hz, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, kError);
  FrequencyResponse h;
  h.averages = 10.0;
  for (double f_Hz = 0.5; f_Hz < 90.0; f_Hz += 0.5) {
    h.frequency_Hz.push_back(f_Hz);
    // an axis of 30 kg: 1 / (i w m)
    const Complex rigid = 1.0 / Complex(0.0, 2.0 * M_PI * f_Hz * 30.0);
    h.value.push_back(rigid * of_Hz(f_Hz) * (1.0 + Complex(noise(random), noise(random))));
    h.coherence.push_back(0.95);
    h.error_ratio.push_back(kError);
  }
  return h;
}

Complex rigid(double /*f_Hz*/) { return 1.0; }

FrequencyResponse rigid_model() {
  FrequencyResponse h = response(rigid, 0);
  for (std::size_t i = 0; i < h.value.size(); ++i) {
    h.value[i] = 1.0 / Complex(0.0, 2.0 * M_PI * h.frequency_Hz[i] * 30.0);
    h.error_ratio[i] = 0.0;
  }
  return h;
}

const std::vector<bool> kAll(179, true);

TEST(Resonance, IsFoundWithItsDampingWithinItsErrors) {
  int far = 0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const auto found =
        resonance(response([](double f) { return ringing(f); }, seed), rigid_model(), kAll);
    ASSERT_TRUE(found.has_value()) << seed;
    far += std::abs(found->frequency_Hz - kFrequency_Hz) > 3.0 * found->frequency_error_Hz;
    far += std::abs(found->damping_ratio - kDamping) > 3.0 * found->damping_error;
    EXPECT_LT(found->frequency_error_Hz, 0.5);
    EXPECT_LT(found->damping_error, 0.01);
  }
  EXPECT_LE(far, 2);
}

TEST(Resonance, IsFoundBesideTheNotchOfADrivenPart) {
  // the driven part of two: (1 + 2 d q s + q^2 s^2) / (1 + 2 d s + s^2), the notch at f0 / q
  constexpr double kNotch = 1.2;
  const auto driven = [](double f_Hz) {
    const Complex s(0.0, f_Hz / kFrequency_Hz);
    return (1.0 + 2.0 * kDamping * kNotch * s + kNotch * kNotch * s * s) * ringing(f_Hz);
  };
  const auto found = resonance(response(driven, 7), rigid_model(), kAll);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->frequency_Hz, kFrequency_Hz, 3.0 * found->frequency_error_Hz);
  EXPECT_NEAR(found->damping_ratio, kDamping, 3.0 * found->damping_error);
}

TEST(Resonance, IsNotFoundInWhatTheModelHas) {
  int found = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    found += resonance(response(rigid, seed), rigid_model(), kAll).has_value();
    // a mass that is 40 % off and 5 ms of delay are no resonance
    const auto late = [](double f) { return 1.4 * std::polar(1.0, -2.0 * M_PI * f * 0.005); };
    found += resonance(response(late, seed), rigid_model(), kAll).has_value();
    // neither is a well damped lag of second order
    const auto lag = [](double f) { return ringing(f, 0.7); };
    found += resonance(response(lag, seed), rigid_model(), kAll).has_value();
  }
  EXPECT_EQ(found, 0);
}

TEST(Resonance, AtTheEndOfWhatIsExcitedIsNoFinding) {
  std::vector<bool> used = kAll;
  for (std::size_t i = 0; i < used.size(); ++i) used[i] = 0.5 * double(i + 1) < 34.5;
  EXPECT_FALSE(
      resonance(response([](double f) { return ringing(f); }, 3), rigid_model(), used).has_value());
}

}  // namespace
}  // namespace estimator::spectra
