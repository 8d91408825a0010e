#include "estimator/greybox/tracking/window_fusion.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace estimator::greybox::tracking {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Limit of chi-square in standard deviations above its mean.
constexpr double kChanceSpread = 4.0;

}  // namespace

WindowFusion::WindowFusion(std::size_t parameters, std::size_t apart, std::size_t most)
    : parameters_(parameters),
      apart_(apart),
      most_(most),
      length_(1 + parameters + parameters * parameters),
      ring_(length_ * (apart * (most - 1) + 1), 0.0) {}

std::size_t WindowFusion::at(std::size_t looks_ago) const noexcept {
  return length_ * ((looks_ - 1 - looks_ago) % (ring_.size() / length_));
}

void WindowFusion::add(const VectorXd& theta, const MatrixXd& covariance, bool good) {
  ++looks_;
  double* const look = ring_.data() + at(0);
  look[0] = good ? 1.0 : 0.0;
  std::copy(theta.data(), theta.data() + parameters_, look + 1);
  std::copy(covariance.data(), covariance.data() + parameters_ * parameters_,
            look + 1 + parameters_);
}

FusedEstimate WindowFusion::fused() const {
  const auto n = static_cast<Index>(parameters_);
  const double most =
      static_cast<double>(n) + kChanceSpread * std::sqrt(2.0 * static_cast<double>(n));
  FusedEstimate out;
  MatrixXd information = MatrixXd::Zero(n, n);
  VectorXd weighted = VectorXd::Zero(n);
  for (std::size_t i = 0; i < most_ && i * apart_ < looks_; ++i) {
    const double* const look = ring_.data() + at(i * apart_);
    if (look[0] == 0.0) break;
    const Eigen::Map<const VectorXd> theta(look + 1, n);
    const Eigen::Map<const MatrixXd> covariance(look + 1 + n, n, n);
    if (i > 0) {
      const VectorXd off = theta - out.theta;
      const MatrixXd both = out.covariance + covariance;
      if (!(off.dot(both.ldlt().solve(off)) < most)) break;
    }
    const MatrixXd inverse = covariance.ldlt().solve(MatrixXd::Identity(n, n));
    if (!inverse.allFinite()) break;
    information += inverse;
    weighted += inverse * theta;
    const auto solved = information.ldlt();
    out.theta = solved.solve(weighted);
    out.covariance = solved.solve(MatrixXd::Identity(n, n));
    ++out.windows;
  }
  return out;
}

void WindowFusion::serialize(estimator::StateArchive& archive) {
  archive.fixed(ring_);
  archive.value(looks_);
}

}  // namespace estimator::greybox::tracking
