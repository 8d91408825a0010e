#include "estimator/residual/special.h"

#include <cmath>
#include <limits>

namespace estimator::residual {
namespace {

constexpr double kEnough = 1e-15;
constexpr double kTiny = 1e-300;
constexpr int kMostTerms = 100000;

double kept_off_zero(double x) { return std::abs(x) < kTiny ? kTiny : x; }

/// Continued fraction of the incomplete beta function, x < (a + 1)/(a + b + 2).
double beta_fraction(double a, double b, double x) {
  double c = 1.0;
  double d = 1.0 / kept_off_zero(1.0 - (a + b) * x / (a + 1.0));
  double h = d;
  for (int m = 1; m < kMostTerms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1.0 / kept_off_zero(1.0 + even * d);
    c = kept_off_zero(1.0 + even / c);
    h *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1.0 / kept_off_zero(1.0 + odd * d);
    c = kept_off_zero(1.0 + odd / c);
    h *= d * c;
    if (std::abs(d * c - 1.0) < kEnough) break;
  }
  return h;
}

double beta_regularised(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1.0) / (a + b + 2.0)) return front * beta_fraction(a, b, x) / a;
  return 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

/// x > 0 with upper(x) = p; `beyond`: where to begin to look.
template <class F>
double quantile_upper(double p, double beyond, const F& upper) {
  double low = 0.0;
  double high = beyond;
  while (upper(high) > p) high *= 2.0;
  for (int k = 0; k < 200 && high - low > 1e-14 * high; ++k) {
    const double middle = 0.5 * (low + high);
    (upper(middle) > p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double chi_square_upper(double x, double dof) {
  if (std::isnan(x) || std::isnan(dof)) return std::numeric_limits<double>::quiet_NaN();
  if (!(x > 0.0)) return 1.0;
  if (std::isinf(x)) return 0.0;
  const double a = dof / 2.0;
  const double z = x / 2.0;
  const double front = std::exp(a * std::log(z) - z - std::lgamma(a));
  if (z < a + 1.0) {
    double term = 1.0 / a;
    double sum = term;
    for (int k = 1; k < kMostTerms && term > kEnough * sum; ++k) {
      term *= z / (a + k);
      sum += term;
    }
    return 1.0 - front * sum;
  }
  double b = z + 1.0 - a;
  double c = 1.0 / kTiny;
  double d = 1.0 / b;
  double h = d;
  for (int k = 1; k < kMostTerms; ++k) {
    const double an = -k * (k - a);
    b += 2.0;
    d = 1.0 / kept_off_zero(an * d + b);
    c = kept_off_zero(b + an / c);
    h *= d * c;
    if (std::abs(d * c - 1.0) < kEnough) break;
  }
  return front * h;
}

double student_two_sided(double t, double dof) {
  if (std::isnan(t)) return t;
  return beta_regularised(dof / 2.0, 0.5, dof / (dof + t * t));
}

double normal_two_sided(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

double chi_square_quantile_upper(double p, double dof) {
  return quantile_upper(p, dof + 10.0, [&](double x) { return chi_square_upper(x, dof); });
}

double f_quantile_upper(double p, double dof1, double dof2) {
  return quantile_upper(p, 10.0, [&](double x) {
    return beta_regularised(dof2 / 2.0, dof1 / 2.0, dof2 / (dof2 + dof1 * x));
  });
}

}  // namespace estimator::residual
