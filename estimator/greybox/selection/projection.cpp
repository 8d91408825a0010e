#include "estimator/greybox/selection/projection.h"

#include <cmath>
#include <utility>

namespace estimator::greybox::selection {

using Eigen::Index;
using Eigen::VectorXd;

Projection::Projection(const FitSummary& fitted, const VectorXd& weights)
    : weights_(weights),
      jacobian_(fitted.jacobian),
      prior_mean_(VectorXd::Zero(fitted.jacobian.cols())),
      per_prior_sd_(VectorXd::Zero(fitted.jacobian.cols())),
      per_sigma_(1.0 / fitted.sigma_m) {
  weighted_jacobian_ = weights_.asDiagonal() * fitted.jacobian * per_sigma_;
  Eigen::MatrixXd normal = weighted_jacobian_.transpose() * weighted_jacobian_;
  for (Index i = 0; i < normal.rows(); ++i) {
    const FreeParameter& p = fitted.parameters[static_cast<std::size_t>(i)];
    if (std::isfinite(p.prior_sd)) {
      prior_mean_[i] = p.prior_mean;
      per_prior_sd_[i] = 1.0 / p.prior_sd;
      normal(i, i) += per_prior_sd_[i] * per_prior_sd_[i];
    } else {  // one that neither record nor prior determines stays fixed here
      normal(i, i) += 1e-9 * normal(i, i) + 1e-12;
    }
  }
  normal_.compute(normal);
  cost_ = remaining(fitted.residual_m, fitted.theta);
}

Projection::Weighed Projection::residual(const Eigen::Ref<const VectorXd>& residual_m,
                                         const Eigen::Ref<const VectorXd>& theta) const {
  Weighed result = signature(residual_m);
  result.strain = per_prior_sd_.cwiseProduct(theta.head(prior_mean_.size()) - prior_mean_);
  result.onto += per_prior_sd_.cwiseProduct(result.strain);
  return result;
}

Projection::Weighed Projection::signature(const Eigen::Ref<const VectorXd>& signature_m) const {
  VectorXd series = weights_.cwiseProduct(signature_m) * per_sigma_;
  VectorXd onto = weighted_jacobian_.transpose() * series;
  return {std::move(series), VectorXd::Zero(prior_mean_.size()), std::move(onto)};
}

double Projection::left(const Weighed& one, const Weighed& other) const {
  return one.series.dot(other.series) + one.strain.dot(other.strain) -
         one.onto.dot(normal_.solve(other.onto));
}

double Projection::remaining(const Eigen::Ref<const VectorXd>& residual_m,
                             const Eigen::Ref<const VectorXd>& theta) const {
  const Weighed r = residual(residual_m, theta);
  return left(r, r);
}

std::pair<double, double> Projection::with(const Eigen::Ref<const VectorXd>& residual_m,
                                           const Eigen::Ref<const VectorXd>& theta,
                                           const Eigen::Ref<const VectorXd>& signature_m) const {
  const Weighed r = residual(residual_m, theta);
  const Weighed d = signature(signature_m);
  const double rr = left(r, r);
  const double dd = left(d, d);
  const double rd = left(r, d);
  if (!(dd > 0.0)) return {rr, 0.0};
  return {rr - rd * rd / dd, -rd / dd};
}

Projection::Two Projection::with(const Eigen::Ref<const VectorXd>& residual_m,
                                 const Eigen::Ref<const VectorXd>& theta,
                                 const Eigen::Ref<const VectorXd>& first_m,
                                 const Eigen::Ref<const VectorXd>& second_m) const {
  const Weighed r = residual(residual_m, theta);
  const Weighed d = signature(first_m);
  const Weighed e = signature(second_m);
  const double dd = left(d, d);
  const double ee = left(e, e);
  const double de = left(d, e);
  const double rd = left(r, d);
  const double re = left(r, e);
  const double rr = left(r, r);
  const double determinant = dd * ee - de * de;
  if (!(determinant > 1e-9 * dd * ee)) return {rr, 0.0, 0.0};
  const double first = -(rd * ee - re * de) / determinant;
  const double second = -(re * dd - rd * de) / determinant;
  return {rr + first * rd + second * re, first, second};
}

VectorXd Projection::beyond(const Eigen::Ref<const VectorXd>& signature_m) const {
  const VectorXd d = weights_.cwiseProduct(signature_m) * per_sigma_;
  return signature_m - jacobian_ * normal_.solve(weighted_jacobian_.transpose() * d);
}

}  // namespace estimator::greybox::selection
