// Data of reference/make_numbers.py, and random records with known coefficients.
#pragma once

#include <random>
#include <vector>

#include "estimator/structures/polynomial.h"
#include "tests/estimator/data.h"

namespace estimator::structures::testing_data {

using estimator::testing_data::lcg;

struct Record {
  std::vector<double> u_V, y_m, reference_m;
  [[nodiscard]] Stretches all() const { return {{u_V, y_m}}; }
};

/// A y = B/F u + constant/F + C/D e, everything 0 before the first sample.
inline std::vector<double> respond(const Polynomial& p, const std::vector<double>& u,
                                   const std::vector<double>& e) {
  const auto back = [](const std::vector<double>& c, const std::vector<double>& x, int t) {
    double sum = 0.0;
    for (int i = 1; i <= static_cast<int>(c.size()) && i <= t; ++i) sum += c[i - 1] * x[t - i];
    return sum;
  };
  const int n = static_cast<int>(u.size());
  std::vector<double> w(n, 0.0), v(n, 0.0), y(n, 0.0);
  for (int t = 0; t < n; ++t) {
    w[t] = p.constant_m - back(p.f, w, t);
    for (int i = 0; i < static_cast<int>(p.b.size()) && p.k + i <= t; ++i) {
      w[t] += p.b[i] * u[t - p.k - i];
    }
    v[t] = e[t] + back(p.c, e, t) - back(p.d, v, t);
    y[t] = w[t] + v[t] - back(p.a, y, t);
  }
  return y;
}

inline constexpr int kCount = 1500;
inline std::vector<double> tenth(std::vector<double> x) {
  for (double& value : x) value *= 0.1;
  return x;
}
inline Polynomial armax_truth() {
  return {.a = {-1.5, 0.7}, .b = {0.5, 0.3}, .c = {-0.8, 0.3}, .d = {}, .f = {}};
}
inline Polynomial box_jenkins_truth() {
  return {.a = {}, .b = {0.5, 0.3}, .c = {0.5}, .d = {-0.9}, .f = {-1.2, 0.5}};
}
inline Record armax_record() {
  Record out{lcg(kCount, 11), {}, {}};
  out.y_m = respond(armax_truth(), out.u_V, tenth(lcg(kCount, 12)));
  return out;
}
inline Record box_jenkins_record() {
  Record out{lcg(kCount, 11), {}, {}};
  out.y_m = respond(box_jenkins_truth(), out.u_V, tenth(lcg(kCount, 12)));
  return out;
}

/// Normal u of variance 1, normal e of `noise_m`.
inline Record random_record(const Polynomial& truth, int count, double noise_m,
                            std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Record out;
  std::vector<double> e;
  for (int t = 0; t < count; ++t) {
    out.u_V.push_back(normal(random));
    e.push_back(noise_m * normal(random));
  }
  out.y_m = respond(truth, out.u_V, e);
  return out;
}

/// An integrating rod with a lag in a proportional loop that follows filtered noise:
///   x(t) = 1.6 x(t-1) - 0.6 x(t-2) + 2e-4 u(t-1) + equation noise,  y = x + position noise,
///   u = 150 (r - y)
inline Record closed_loop(int count, double equation_m, double position_m, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Record out;
  double x1 = 0.0, x2 = 0.0, u1 = 0.0, r = 0.0;
  for (int t = 0; t < count; ++t) {
    const double x = 1.6 * x1 - 0.6 * x2 + 2e-4 * u1 + equation_m * normal(random);
    const double y = x + position_m * normal(random);
    r = 0.95 * r + 0.002 * normal(random);
    const double u = 150.0 * (r - y);
    out.y_m.push_back(y);
    out.u_V.push_back(u);
    out.reference_m.push_back(r);
    x2 = x1;
    x1 = x;
    u1 = u;
  }
  return out;
}
inline const std::vector<double> kClosedLoop{-1.6, 0.6, 2e-4};

}  // namespace estimator::structures::testing_data
