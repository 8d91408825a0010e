#include "estimator/fdi/region.h"

#include <cmath>

#include "config/schema/error.h"

namespace estimator::fdi {
namespace {

/// Continued fraction of the incomplete beta function, Abramowitz and Stegun 26.5.8.
double beta_fraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  const auto kept = [](double v) { return std::abs(v) < kTiny ? kTiny : v; };
  double c = 1.0;
  double d = 1.0 / kept(1.0 - (a + b) * x / (a + 1.0));
  double h = d;
  for (int m = 1; m < 10000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1.0 / kept(1.0 + even * d);
    c = kept(1.0 + even / c);
    h *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1.0 / kept(1.0 + odd * d);
    c = kept(1.0 + odd / c);
    h *= d * c;
    if (std::abs(d * c - 1.0) < 1e-15) break;
  }
  return h;
}

}  // namespace

double f_upper(double x, double d1, double d2) {
  if (!(x > 0.0)) return 1.0;
  const double a = d2 / 2.0;
  const double b = d1 / 2.0;
  const double z = d2 / (d2 + d1 * x);
  const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                a * std::log(z) + b * std::log1p(-z));
  if (z < (a + 1.0) / (a + b + 2.0)) return front * beta_fraction(a, b, z) / a;
  return 1.0 - front * beta_fraction(b, a, 1.0 - z) / b;
}

double f_quantile_upper(double p, double d1, double d2) {
  double low = 0.0;
  double high = 10.0;
  while (f_upper(high, d1, d2) > p) high *= 2.0;
  for (int k = 0; k < 200 && high - low > 1e-13 * high; ++k) {
    const double middle = 0.5 * (low + high);
    (f_upper(middle, d1, d2) > p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Region::Region(std::span<const double> mean, std::span<const double> covariance, double blocks,
               const std::string& where)
    : mean_(Eigen::Map<const Eigen::VectorXd>(mean.data(), static_cast<Eigen::Index>(mean.size()))),
      x_(mean_.size()),
      solved_(mean_.size()),
      blocks_(blocks) {
  using config::schema::bad_config;
  const Eigen::Index d = mean_.size();
  if (covariance.size() != mean.size() * mean.size() || d == 0) {
    throw bad_config(where, "covariance has not a number for each pair of values");
  }
  if (!(blocks > static_cast<double>(d) + 1.0)) {
    throw bad_config(where, "was learned from fewer blocks than values",
                     std::to_string(d + 2) + " or more");
  }
  Eigen::MatrixXd s = Eigen::Map<const Eigen::MatrixXd>(covariance.data(), d, d);
  scale_ = s.diagonal().cwiseSqrt();
  if (!(scale_.minCoeff() > 0.0) || !scale_.allFinite()) {
    throw bad_config(where, "has a value that does not vary");
  }
  s = scale_.cwiseInverse().asDiagonal() * s * scale_.cwiseInverse().asDiagonal();
  // Values that follow from others would make the region flat: rounding must not count.
  constexpr double kLeast = 1e-9;
  s.diagonal().array() += kLeast;
  const Eigen::LLT<Eigen::MatrixXd> factor(s);
  if (factor.info() != Eigen::Success || !s.allFinite()) {
    throw bad_config(where, "covariance is not positive definite");
  }
  inverse_ = factor.solve(Eigen::MatrixXd::Identity(d, d));
  const Eigen::MatrixXd l = factor.matrixL();
  log_det_ = 2.0 * (l.diagonal().array().log().sum() + scale_.array().log().sum());
}

double Region::distance2(std::span<const double> x) noexcept {
  for (Eigen::Index i = 0; i < mean_.size(); ++i) {
    x_(i) = (x[static_cast<std::size_t>(i)] - mean_(i)) / scale_(i);
  }
  solved_.noalias() = inverse_ * x_;
  distance2_ = x_.dot(solved_);
  double greatest = -1.0;
  for (Eigen::Index i = 0; i < mean_.size(); ++i) {
    const double own = solved_(i) * solved_(i) / inverse_(i, i);
    if (own <= greatest) continue;
    greatest = own;
    most_ = static_cast<std::size_t>(i);
  }
  return distance2_;
}

double Region::limit(double p) const {
  const auto d = static_cast<double>(mean_.size());
  const double n = blocks_;
  return d * (n + 1.0) * (n - 1.0) / (n * (n - d)) * f_quantile_upper(p, d, n - d);
}

}  // namespace estimator::fdi
