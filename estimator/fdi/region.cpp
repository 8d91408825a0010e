#include "estimator/fdi/region.h"

#include <cmath>

#include "config/schema/error.h"
#include "estimator/residual/distributions.h"

namespace estimator::fdi {

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
  return d * (n + 1.0) * (n - 1.0) / (n * (n - d)) * residual::f_quantile_upper(p, d, n - d);
}

}  // namespace estimator::fdi
