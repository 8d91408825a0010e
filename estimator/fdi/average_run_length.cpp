#include "estimator/fdi/average_run_length.h"

#include <Eigen/Dense>
#include <cmath>

namespace estimator::fdi {
namespace {

constexpr double kRootTwo = 1.4142135623730951;
constexpr double kRootTwoPi = 2.5066282746310002;

double normal_below(double z) { return 0.5 * std::erfc(-z / kRootTwo); }
double normal_density(double z) { return std::exp(-0.5 * z * z) / kRootTwoPi; }

/// x with f(x) = 0 for a rising f.
template <class F>
double root(double low, double high, F&& f) {
  while (f(high) < 0.0) high *= 1.5;
  for (int i = 0; i < 60 && high - low > 1e-9 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double cusum_run_length(double k, double h, double shift) {
  constexpr int kStates = 101;
  const double width = 2.0 * h / (2 * kStates - 1);
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(kStates, kStates);
  for (int i = 0; i < kStates; ++i) {
    double below = normal_below(k - shift + (0.5 - i) * width);
    a(i, 0) -= below;
    for (int j = 1; j < kStates; ++j) {
      const double upper = normal_below(k - shift + (j - i + 0.5) * width);
      a(i, j) -= upper - below;
      below = upper;
    }
  }
  return a.partialPivLu().solve(Eigen::VectorXd::Ones(kStates))(0);
}

double cusum_threshold(double k, double run_length, double mean_error) {
  const double wanted = std::log(run_length);
  return root(1e-3, 4.0, [&](double h) {
    const double rate =
        1.0 / cusum_run_length(k, h, mean_error) + 1.0 / cusum_run_length(k, h, -mean_error);
    return -std::log(rate) - wanted;
  });
}

double glr_run_length(double b, int window) {
  constexpr int kSteps = 2000;
  const double from = b / std::sqrt(static_cast<double>(window));
  // One value alone has no window between n = 1 and W.
  if (window <= 1) return 1.0 / std::erfc(b / kRootTwo);
  const double step = (b - from) / kSteps;
  double integral = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = from + (i + 0.5) * step;
    const double nu = (2.0 / x) * (normal_below(x / 2) - 0.5) /
                      ((x / 2) * normal_below(x / 2) + normal_density(x / 2));
    integral += x * nu * nu * step;
  }
  return kRootTwoPi * std::exp(0.5 * b * b) / (b * integral);
}

double glr_threshold(double run_length, int window, double mean_error) {
  constexpr double kShorter = 1.2;  // safety factor on the asymptotic formula
  const double wanted = std::log(window > 1 ? kShorter * run_length : run_length);
  const double b =
      root(1.5, 5.0, [&](double x) { return std::log(glr_run_length(x, window)) - wanted; });
  return b + mean_error * std::sqrt(static_cast<double>(window));
}

}  // namespace estimator::fdi
