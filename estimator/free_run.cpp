#include "estimator/free_run.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "config/signals/nan.h"

namespace estimator {
namespace {

using config::signals::kNaN;

/// psi' theta at sample t, past outputs taken from `y_m`.
double predict(const Structure& s, const double* theta, const double* u_V, const double* y_m,
               std::ptrdiff_t t) noexcept {
  double sum = s.constant ? theta[s.n + s.m] : 0.0;
  for (int i = 0; i < s.n; ++i) sum -= theta[i] * y_m[t - 1 - i];
  for (int i = 0; i < s.m; ++i) sum += theta[s.n + i] * u_V[t - s.k - i];
  return sum;
}

}  // namespace

std::vector<double> free_run(const Structure& structure, std::span<const double> coefficients,
                             std::span<const double> u_V, std::span<const double> y_m) {
  assert(u_V.size() == y_m.size() &&
         coefficients.size() >= static_cast<std::size_t>(structure.size()));
  std::vector<double> out(y_m.begin(), y_m.end());
  for (auto t = static_cast<std::size_t>(structure.history()); t < out.size(); ++t) {
    out[t] = predict(structure, coefficients.data(), u_V.data(), out.data(),
                     static_cast<std::ptrdiff_t>(t));
  }
  return out;
}

std::vector<double> one_step_errors(const Structure& structure,
                                    std::span<const double> coefficients,
                                    std::span<const double> u_V, std::span<const double> y_m) {
  assert(u_V.size() == y_m.size() &&
         coefficients.size() >= static_cast<std::size_t>(structure.size()));
  std::vector<double> out(y_m.size(), kNaN);
  for (auto t = static_cast<std::size_t>(structure.history()); t < out.size(); ++t) {
    out[t] = y_m[t] - predict(structure, coefficients.data(), u_V.data(), y_m.data(),
                              static_cast<std::ptrdiff_t>(t));
  }
  return out;
}

Fit compare(std::span<const double> measured_m, std::span<const double> predicted_m, int skip,
            int shift) {
  std::vector<double> errors_m;
  const auto size = static_cast<std::ptrdiff_t>(std::min(measured_m.size(), predicted_m.size()));
  for (std::ptrdiff_t t = skip; t < size; ++t) {
    const std::ptrdiff_t other = t - shift;
    if (other < skip || other >= size) continue;
    // A diverged prediction counts; only a missing measurement does not.
    if (std::isnan(measured_m[t])) continue;
    const double error_m = measured_m[t] - predicted_m[other];
    errors_m.push_back(std::isnan(error_m) ? std::numeric_limits<double>::infinity() : error_m);
  }
  return summarize(errors_m);
}

Fit summarize(std::span<const double> errors_m) {
  Fit out;
  for (const double error_m : errors_m) {
    if (std::isnan(error_m)) continue;
    out.cost_m2 += error_m * error_m;
    ++out.samples;
  }
  out.rms_m = out.samples > 0 ? std::sqrt(out.cost_m2 / out.samples) : kNaN;
  return out;
}

}  // namespace estimator
