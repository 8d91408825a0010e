// Data sets that the tests share.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "estimator/structure.h"

namespace estimator::testing_data {

struct Data {
  std::vector<double> u_V, y_m;
};

/// The generator of reference/make_numbers.py: multiples of 1/1024 in [-0.5, 0.5).
inline std::vector<double> lcg(int count, std::uint64_t seed) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) {
    seed = (seed * 1103515245 + 12345) % 2147483648ULL;
    out.push_back((static_cast<double>((seed >> 16) % 1024) - 512.0) / 1024.0);
  }
  return out;
}

/// y of a known difference equation driven by `u_V`, with white noise in the equation.
inline std::vector<double> simulate(const Structure& s, const std::vector<double>& theta,
                                    const std::vector<double>& u_V, double noise_m,
                                    std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<double> y(u_V.size());
  for (int t = 0; t < static_cast<int>(u_V.size()); ++t) {
    double sum = noise_m * normal(random) + (s.constant ? theta.back() : 0.0);
    for (int i = 1; i <= s.n && i <= t; ++i) sum -= theta[i - 1] * y[t - i];
    for (int i = 0; i < s.m && s.k + i <= t; ++i) sum += theta[s.n + i] * u_V[t - s.k - i];
    y[t] = sum;
  }
  return y;
}

inline const Structure kTruth{2, 2, 1, true};
inline const std::vector<double> kTruthTheta{-1.5, 0.7, 2e-4, -1e-4, 3e-5};

/// kTruth driven by noise.
inline Data excited(int count, double noise_m, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Data out;
  for (int i = 0; i < count; ++i) out.u_V.push_back(normal(random));
  out.y_m = simulate(kTruth, kTruthTheta, out.u_V, noise_m, random);
  return out;
}

/// An integrating actuator, y' = gain u, in a proportional loop following a sine: the plant
/// y(t) = y(t-1) + b u(t-1), u = 250 (r - y), read in steps of `resolution_m` (0: exactly).
/// Two harmonic functions span everything in it: four coefficients are nearly undetermined.
inline Data sine_loop(int count, double resolution_m, double b = 2e-4) {
  Data out;
  double y = 0.0;
  for (int t = 0; t < count; ++t) {
    const double read = resolution_m > 0.0 ? std::round(y / resolution_m) * resolution_m : y;
    const double u = 250.0 * (0.0254 * std::sin(2.0 * 3.14159265358979 * 0.5 * 0.005 * t) - read);
    out.u_V.push_back(u);
    out.y_m.push_back(read);
    y += b * u;
  }
  return out;
}

}  // namespace estimator::testing_data
