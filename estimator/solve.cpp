#include "estimator/solve.h"

#include <Eigen/SVD>
#include <cmath>
#include <limits>

namespace estimator {
namespace {

using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxColumns, 1>;

/// Column lengths, 1 in place of 0.
Vector scales(const Small& upper) {
  Vector out = upper.colwise().stableNorm().transpose();
  for (double& length : out) length = length > 0.0 ? length : 1.0;
  return out;
}

void shortest_solution(const Small& scaled, const Vector& scale, const Vector& z,
                       double max_condition, Estimate& out) {
  Eigen::JacobiSVD<Small> svd(scaled, Eigen::ComputeFullU | Eigen::ComputeFullV);
  svd.setThreshold(1.0 / max_condition);
  const Vector theta = svd.solve(z);
  for (int i = 0; i < out.size; ++i) out.value[i] = theta[i] / scale[i];
}

}  // namespace

Small triangle(const SquareRootInformation& factor) noexcept {
  const int columns = factor.columns();
  Small out = Small::Zero(columns, columns);
  for (int i = 0; i < columns; ++i) {
    const double root = std::sqrt(factor.weight(i));
    for (int j = i; j < columns; ++j) out(i, j) = root * factor.unit(i, j);
  }
  return out;
}

double scaled_condition(const Small& upper) noexcept {
  const Small scaled = upper * scales(upper).cwiseInverse().asDiagonal();
  const auto singular = Eigen::JacobiSVD<Small>(scaled).singularValues().eval();
  const double smallest = singular[singular.size() - 1];
  return smallest > 0.0 ? singular[0] / smallest : std::numeric_limits<double>::infinity();
}

Small inverse(const Small& upper) noexcept {
  const Eigen::Index p = upper.cols();
  Small out = Small::Zero(p, p);
  for (Eigen::Index j = 0; j < p; ++j) {
    out(j, j) = 1.0 / upper(j, j);
    for (Eigen::Index i = j - 1; i >= 0; --i) {
      double sum = 0.0;
      for (Eigen::Index k = i + 1; k <= j; ++k) sum += upper(i, k) * out(k, j);
      out(i, j) = -sum / upper(i, i);
    }
  }
  return out;
}

Estimate solve(const Small& augmented, int rows, const Limits& limits) noexcept {
  Estimate out;
  const int p = static_cast<int>(augmented.cols()) - 1;
  out.size = p;
  out.samples = rows;
  out.value.fill(kNaN);
  out.std_error.fill(kNaN);
  if (rows <= p) return out;
  if (!augmented.allFinite()) {
    out.reason = Reason::not_finite;
    return out;
  }
  const Small r = augmented.topLeftCorner(p, p);
  const Vector z = augmented.col(p).head(p);
  const double rho_m = std::abs(augmented(p, p));
  out.residual_rms_m = rho_m / std::sqrt(rows);
  out.condition = scaled_condition(r);
  if (!(out.condition <= limits.max_condition)) {
    const Vector scale = scales(r);
    shortest_solution(r * scale.cwiseInverse().asDiagonal(), scale, z, limits.max_condition, out);
    out.reason = Reason::rank_deficient;
    return out;
  }
  const Small unscaled = inverse(r);
  const double deviation_m = rho_m / std::sqrt(rows - p);
  const Vector theta = r.triangularView<Eigen::Upper>().solve(z);
  for (int i = 0; i < p; ++i) {
    out.value[i] = theta[i];
    out.std_error[i] = deviation_m * unscaled.row(i).tail(p - i).norm();
  }
  out.valid = theta.allFinite();
  out.reason = out.valid ? Reason::none : Reason::not_finite;
  return out;
}

}  // namespace estimator
