// The noise floor of readings whose noise and rounding are known: sqrt(noise^2 + step^2 / 12).
#include "estimator/residual/noise_floor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace estimator::residual {
namespace {

std::vector<double> readings(const std::function<double(double)>& motion_m, double noise_m,
                             double step_m, double decimals_m, std::uint64_t seed = 1,
                             int samples = 6000) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> draw;
  std::vector<double> out;
  for (int k = 0; k < samples; ++k) {
    double y = motion_m(0.005 * k) + noise_m * draw(engine);
    if (step_m > 0.0) y = step_m * std::round(y / step_m);
    if (decimals_m > 0.0) y = decimals_m * std::round(y / decimals_m);
    out.push_back(y);
  }
  return out;
}

double multisine(double t) {
  double sum = 0.3;
  for (int k = 1; k <= 10; ++k) {
    sum += 0.006 / std::sqrt(k) * std::sin(2 * M_PI * 0.5 * k * t + 1.7 * k * k);
  }
  return sum;
}

/// Steps every 0.7 s through a loop of 12 Hz and damping 0.5, closed form.
double steps(double t) {
  double sum = 0.3;
  const double w = 2 * M_PI * 12.0;
  const double wd = w * std::sqrt(0.75);
  for (int k = 0; 0.7 * k <= t; ++k) {
    const double s = t - 0.7 * k;
    const double size = 0.02 * std::sin(2.3 * k + 0.4);
    sum +=
        size * (1 - std::exp(-0.5 * w * s) * (std::cos(wd * s) + 0.5 * w / wd * std::sin(wd * s)));
  }
  return sum;
}

constexpr double kFloor_m = 2.466e-6;  // sqrt(2^2 + 25/12) um

TEST(NoiseFloor, IsNoiseAndRoundingTogetherOnAMultisineAndOnFastSteps) {
  double mean = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const NoiseFloor a = noise_floor(readings(multisine, 2e-6, 5e-6, 1e-6, seed), 0.005);
    const NoiseFloor b = noise_floor(readings(steps, 2e-6, 5e-6, 1e-6, seed), 0.005);
    for (const NoiseFloor& found : {a, b}) {
      EXPECT_NEAR(found.encoder_step_m, 5e-6, 1e-9);
      // At the 43 rests, rounding is not uniform: 8 %.
      EXPECT_NEAR(found.sd_m, kFloor_m, 0.08 * kFloor_m) << seed;
      EXPECT_FALSE(found.at_rest);
    }
    mean += 0.1 * a.sd_m;
  }
  EXPECT_NEAR(mean, kFloor_m, 0.015 * kFloor_m);
}

TEST(NoiseFloor, OfARodAtRestIsNeverBelowTheRounding) {
  const auto rest = [](double) { return 0.3000007; };
  const NoiseFloor noisy = noise_floor(readings(rest, 2e-6, 5e-6, 1e-6), 0.005);
  EXPECT_TRUE(noisy.at_rest);
  EXPECT_NEAR(noisy.encoder_step_m, 5e-6, 1e-9);
  EXPECT_NEAR(noisy.sd_m, kFloor_m, 0.15 * kFloor_m);
  // Quiet, and moving now and then only: the long rests would show no noise at all.
  const auto mostly_rest = [](double t) {
    return 0.3 + (std::fmod(t, 5.0) < 1.0 ? 0.005 * (1 - std::cos(2 * M_PI * t)) : 0.0);
  };
  const NoiseFloor quiet = noise_floor(readings(mostly_rest, 1e-7, 5e-6, 1e-6), 0.005);
  EXPECT_GE(quiet.sd_m, 5e-6 / std::sqrt(12.0));
  EXPECT_LE(quiet.sd_m, 1.2 * 5e-6 / std::sqrt(12.0));
}

TEST(NoiseFloor, OfAnInterpolatedEncoderAtRestIsThatOfItsMotion) {
  // read with jitter at about 140 Hz, interpolated to 200 Hz: no step is left to be found
  const auto moves = [](double t) {
    return 0.3 + (std::fmod(t, 2.0) < 1.0 ? 0.01 * (1 - std::cos(2 * M_PI * t)) : 0.0);
  };
  constexpr double kStep_m = 150e-6;
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> wait_s(0.006, 0.0083);
  const auto reading = [&](double t) { return kStep_m * std::round(moves(t) / kStep_m); };
  std::vector<double> y_m;
  double square_m2 = 0.0;
  double moving = 0.0;
  double from_s = 0.0;
  double to_s = wait_s(engine);
  for (int k = 0; k < 2400; ++k) {
    const double t = 0.005 * k;
    while (to_s < t) {
      from_s = to_s;
      to_s += wait_s(engine);
    }
    const double share = (t - from_s) / (to_s - from_s);
    y_m.push_back(reading(from_s) + share * (reading(to_s) - reading(from_s)));
    if (std::fmod(t, 2.0) >= 1.0) continue;
    square_m2 += std::pow(y_m.back() - moves(t), 2);
    moving += 1.0;
  }
  const double error_m = std::sqrt(square_m2 / moving);
  const NoiseFloor found = noise_floor(y_m, 0.005);
  EXPECT_EQ(found.encoder_step_m, 0.0);
  EXPECT_LT(found.sd_m, error_m);
  EXPECT_GT(found.sd_m, 0.1 * error_m);  // interpolation takes most of the high frequencies
}

TEST(NoiseFloor, FindsStepsThatDecimalsBlur) {
  EXPECT_NEAR(encoder_step_m(readings(multisine, 2e-6, 1.2207e-6, 1e-7)), 1.2207e-6, 2e-9);
  EXPECT_NEAR(encoder_step_m(readings(multisine, 0.0, 2e-5, 0.0)), 2e-5, 1e-8);
  EXPECT_NEAR(encoder_step_m(readings(multisine, 1e-6, 0.0, 1e-8)), 1e-8, 1e-12);
  EXPECT_LT(encoder_step_m(readings(multisine, 1e-6, 0.0, 0.0)), 1e-8);
}

TEST(NoiseFloor, OfReadingsWithoutRoundingIsTheNoise) {
  const NoiseFloor found = noise_floor(readings(multisine, 7e-6, 0.0, 0.0), 0.005);
  EXPECT_NEAR(found.sd_m, 7e-6, 0.06 * 7e-6);
}

TEST(NoiseFloor, LeavesGapsOutAndSaysNothingOfTooLittle) {
  std::vector<double> y = readings(multisine, 2e-6, 5e-6, 1e-6);
  for (std::size_t t = 1000; t < 1500; ++t) y[t] = std::nan("");
  EXPECT_NEAR(noise_floor(y, 0.005).sd_m, kFloor_m, 0.06 * kFloor_m);
  EXPECT_TRUE(std::isnan(noise_floor(std::vector<double>(20, 0.1), 0.005).sd_m));
  EXPECT_TRUE(std::isnan(noise_floor(y, 0.5).sd_m));
}

}  // namespace
}  // namespace estimator::residual
