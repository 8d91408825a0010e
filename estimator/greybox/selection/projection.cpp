#include "estimator/greybox/selection/projection.h"

#include <cmath>

namespace estimator::greybox::selection {

using Eigen::Index;
using Eigen::VectorXd;

Projection::Projection(const FitSummary& fitted, const VectorXd& weights)
    : weights_(weights), jacobian_(fitted.jacobian), per_sigma_(1.0 / fitted.sigma_m) {
  weighted_jacobian_ = weights_.asDiagonal() * fitted.jacobian * per_sigma_;
  Eigen::MatrixXd normal = weighted_jacobian_.transpose() * weighted_jacobian_;
  for (Index i = 0; i < normal.rows(); ++i) {
    const double sd = fitted.parameters[static_cast<std::size_t>(i)].prior_sd;
    // a parameter that neither record nor prior determines stays fixed here
    normal(i, i) += std::isfinite(sd) ? 1.0 / (sd * sd) : 1e-9 * normal(i, i) + 1e-12;
  }
  normal_.compute(normal);
  const VectorXd own = weights_.cwiseProduct(fitted.residual_m) * per_sigma_;
  const VectorXd onto = weighted_jacobian_.transpose() * own;
  cost_ = remaining(own, onto, own, onto);
}

double Projection::remaining(const VectorXd& weighted, const VectorXd& onto, const VectorXd& other,
                             const VectorXd& other_onto) const {
  return weighted.dot(other) - onto.dot(normal_.solve(other_onto));
}

double Projection::remaining(const Eigen::Ref<const VectorXd>& residual_m) const {
  const VectorXd r = weights_.cwiseProduct(residual_m) * per_sigma_;
  const VectorXd onto = weighted_jacobian_.transpose() * r;
  return remaining(r, onto, r, onto);
}

std::pair<double, double> Projection::with(const Eigen::Ref<const VectorXd>& residual_m,
                                           const Eigen::Ref<const VectorXd>& signature_m) const {
  const VectorXd r = weights_.cwiseProduct(residual_m) * per_sigma_;
  const VectorXd d = weights_.cwiseProduct(signature_m) * per_sigma_;
  const VectorXd r_onto = weighted_jacobian_.transpose() * r;
  const VectorXd d_onto = weighted_jacobian_.transpose() * d;
  const double rr = remaining(r, r_onto, r, r_onto);
  const double dd = remaining(d, d_onto, d, d_onto);
  const double rd = remaining(r, r_onto, d, d_onto);
  if (!(dd > 0.0)) return {rr, 0.0};
  return {rr - rd * rd / dd, -rd / dd};
}

Projection::Two Projection::with(const Eigen::Ref<const VectorXd>& residual_m,
                                 const Eigen::Ref<const VectorXd>& first_m,
                                 const Eigen::Ref<const VectorXd>& second_m) const {
  const auto weighted = [&](const auto& series) -> VectorXd {
    return weights_.cwiseProduct(series) * per_sigma_;
  };
  const VectorXd r = weighted(residual_m);
  const VectorXd d = weighted(first_m);
  const VectorXd e = weighted(second_m);
  const VectorXd r_onto = weighted_jacobian_.transpose() * r;
  const VectorXd d_onto = weighted_jacobian_.transpose() * d;
  const VectorXd e_onto = weighted_jacobian_.transpose() * e;
  const double dd = remaining(d, d_onto, d, d_onto);
  const double ee = remaining(e, e_onto, e, e_onto);
  const double de = remaining(d, d_onto, e, e_onto);
  const double rd = remaining(r, r_onto, d, d_onto);
  const double re = remaining(r, r_onto, e, e_onto);
  const double rr = remaining(r, r_onto, r, r_onto);
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
