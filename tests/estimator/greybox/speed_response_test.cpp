// Responses of records whose motion is written down.
#include "estimator/greybox/validation/speed_response.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "tests/estimator/spectra/white_noise.h"

namespace estimator::greybox::validation {
namespace {

using spectra_test::white_noise;

constexpr double kSampleTime_s = 0.005;

TEST(SpeedResponse, OfALagAfterAnIntegratorIsItsTransferFunction) {
  // v(k+1) = 0.6 v(k) + 0.02 u(k), y(k+1) = y(k) + T v(k): the speed of sample k is v(k)
  const std::vector<double> u_V = white_noise(12000, 1.0, 1);
  std::vector<double> y_m{0.3};
  double v_mps = 0.0;
  for (std::size_t k = 0; k + 1 < u_V.size(); ++k) {
    y_m.push_back(y_m.back() + kSampleTime_s * v_mps);
    v_mps = 0.6 * v_mps + 0.02 * u_V[k];
  }
  const Dataset record = dataset_of(kSampleTime_s, u_V, y_m);
  const spectra::FrequencyResponse h = speed_response(record, record.y_m);
  ASSERT_FALSE(h.empty());
  for (std::size_t i = 0; i < h.value.size(); ++i) {
    const auto z = std::polar(1.0, 2.0 * std::numbers::pi * h.frequency_Hz[i] * kSampleTime_s);
    EXPECT_LT(std::abs(h.value[i] * (z - 0.6) / 0.02 - 1.0), 0.03) << h.frequency_Hz[i];
  }
}

TEST(SpeedResponse, LeavesOutWhatDoesNotCount) {
  const std::vector<double> u_V = white_noise(4000, 1.0, 2);
  std::vector<double> y_m = white_noise(4000, 1e-6, 3);
  Dataset record = dataset_of(kSampleTime_s, u_V, y_m);
  std::vector<double> with_spike = y_m;
  std::size_t first = 0;
  while (record.valid[first] == 0) ++first;
  ASSERT_GT(first, 0U) << "a segment settles";
  with_spike[first / 2] = 10.0;
  EXPECT_EQ(speed_response(record, with_spike).value, speed_response(record, y_m).value);
}

TEST(ResidualSpectrum, OfASineIsALineWithItsPower) {
  std::vector<double> y_m;
  std::vector<double> residual_m;
  for (int k = 0; k < 6000; ++k) {
    y_m.push_back(0.1 * std::sin(0.01 * k));
    residual_m.push_back(k < 100 ? std::nan("")
                                 : 3e-6 * std::sin(2.0 * std::numbers::pi * 17.0 * 0.005 * k));
  }
  const Dataset record = dataset_of(kSampleTime_s, y_m, y_m);
  const spectra::CrossSpectra s = residual_spectrum(record, residual_m);
  double power = 0.0;
  for (std::size_t i = 0; i < s.input.size(); ++i) {
    if (std::abs(s.frequency_Hz[i] - 17.0) < 2.0) {
      power += s.input[i] * (s.frequency_Hz[1] - s.frequency_Hz[0]);
    }
  }
  EXPECT_NEAR(power, 0.5 * 9e-12, 0.01 * 4.5e-12);
}

/// Two masses with a spring between them, driven at the one and measured at the other; a rigid
/// axis of both as the model.
struct TwoMasses {
  std::vector<double> u_V, y_m, rigid_m;
};

TwoMasses two_masses(double resonance_Hz, double damping_ratio) {
  constexpr int kSubsteps = 50;
  constexpr double kMass_kg = 30.0;
  constexpr double kShare = 0.3;
  const double w = 2.0 * std::numbers::pi * resonance_Hz;
  const double step_s = kSampleTime_s / kSubsteps;
  const std::vector<double> level = white_noise(12000, 2.0, 9);
  const std::vector<double> sensor_m = white_noise(12000, 1e-6, 10);
  TwoMasses out;
  double x = 0.0, v = 0.0, z = 0.0, zv = 0.0, r = 0.0, rv = 0.0;
  for (std::size_t k = 0; k < level.size(); ++k) {
    out.u_V.push_back(level[k]);
    out.y_m.push_back(x + z + sensor_m[k]);
    out.rigid_m.push_back(r);
    for (int i = 0; i < kSubsteps; ++i) {
      const double force_N = 40.0 * level[k] - 120.0 * v;
      // the offset z of the far mass: m2 (a1 + z'') = -spring, m1 a1 = force + spring
      const double spring_N =
          kShare * (1.0 - kShare) * kMass_kg * (w * w * z + 2.0 * damping_ratio * w * zv);
      const double a1 = (force_N + spring_N) / ((1.0 - kShare) * kMass_kg);
      const double a2 = -spring_N / (kShare * kMass_kg);
      v += step_s * a1;
      x += step_s * v;
      zv += step_s * (a2 - a1);
      z += step_s * zv;
      rv += step_s * (40.0 * level[k] - 120.0 * rv) / kMass_kg;
      r += step_s * rv;
    }
  }
  return out;
}

TEST(MissingResonance, OfTwoMassesIsTheirsWithinItsErrors) {
  const TwoMasses motion = two_masses(34.0, 0.03);
  const Dataset record = dataset_of(kSampleTime_s, motion.u_V, motion.y_m);
  std::vector<double> error_m;
  for (std::size_t k = 0; k < motion.y_m.size(); ++k) {
    error_m.push_back(motion.y_m[k] - motion.rigid_m[k]);
  }
  const auto found = missing_resonance(record, error_m, 1e-6);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->frequency_Hz, 34.0, 4.0 * found->frequency_error_Hz);
  // the damping of the driven part adds d r / (2 (1 - r) M w) to the mode's, to first order
  const double truth = 0.03 + 120.0 * 0.3 / (2.0 * 0.7 * 30.0 * 2.0 * std::numbers::pi * 34.0);
  EXPECT_NEAR(found->damping_ratio, truth, 4.0 * found->damping_error);
  EXPECT_LT(found->damping_error, 0.01);
  // and none is missing where the model has it
  EXPECT_FALSE(
      missing_resonance(record, std::vector<double>(record.size(), 0.0), 1e-6).has_value());
}

/// y' = 0.05 u + disturbance in a loop u = 40 V/m (reference - reading).
Dataset in_a_loop(double noise_m, double line_mps, double line_Hz) {
  const std::vector<double> sensor_m = white_noise(12000, noise_m, 21);
  std::vector<double> u_V;
  std::vector<double> read_m;
  double y_m = 0.3;
  for (std::size_t k = 0; k < sensor_m.size(); ++k) {
    const double t_s = kSampleTime_s * static_cast<double>(k);
    read_m.push_back(y_m + sensor_m[k]);
    const double reference_m = 0.3 + 0.02 * std::sin(2.0 * std::numbers::pi * 0.3 * t_s) +
                               0.01 * std::sin(2.0 * std::numbers::pi * 0.7 * t_s);
    u_V.push_back(40.0 * (reference_m - read_m.back()));
    y_m += kSampleTime_s *
           (0.05 * u_V.back() + line_mps * std::sin(2.0 * std::numbers::pi * line_Hz * t_s));
  }
  return dataset_of(kSampleTime_s, u_V, read_m);
}

TEST(Excited, NoiseThatTheControllerFeedsBackIsNoExcitation) {
  const Dataset record = in_a_loop(5e-6, 0.0, 1.0);
  const spectra::FrequencyResponse h = speed_response(record, record.y_m);
  const std::vector<bool> by_coherence = spectra::excited(h, kExcitedError);
  const std::vector<bool> used = excited(record, h, 5e-6);
  int coherent = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (h.frequency_Hz[i] < 5.0) continue;
    coherent += by_coherence[i];
    EXPECT_FALSE(used[i]) << h.frequency_Hz[i];
  }
  EXPECT_GT(coherent, 100) << "the coherence alone would take the controller for the plant";
}

TEST(MissingResonance, IsNoSpectralLineInALoop) {
  for (const double line_Hz : {7.3, 23.0, 50.0}) {
    const Dataset record = in_a_loop(1e-6, 0.02, line_Hz);
    std::vector<double> error_m;  // the model is y' = 0.05 u
    double model_m = record.y_m.front();
    for (std::size_t k = 0; k < record.size(); ++k) {
      error_m.push_back(record.y_m[k] - model_m);
      model_m += kSampleTime_s * 0.05 * record.u_V[k];
    }
    EXPECT_FALSE(missing_resonance(record, error_m, 1e-6).has_value()) << line_Hz;
  }
}

}  // namespace
}  // namespace estimator::greybox::validation
