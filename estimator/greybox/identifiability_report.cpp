#include "estimator/greybox/identifiability_report.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "estimator/linear_algebra/decompositions.h"
#include "estimator/nonlinear/difference.h"
#include "estimator/nonlinear/identifiability.h"
#include "estimator/nonlinear/linear_model.h"

namespace estimator::greybox {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The prior determines a parameter whose posterior spread exceeds this share of the prior's.
constexpr double kHeld = 0.7;
constexpr double kWeak = 1e-2;
constexpr double kRidge = 1e-9;
constexpr std::size_t kMostPartners = 4;

class IdentifiabilityAnalysis {
 public:
  IdentifiabilityAnalysis(const estimator::nonlinear::Problem& problem, const MatrixXd& jacobian,
                          const std::vector<FreeParameter>& parameters, const VectorXd& theta)
      : parameters_(parameters), scale_(theta.size()), prior_(theta.size()) {
    for (Index j = 0; j < theta.size(); ++j) {
      const auto& p = parameters[static_cast<std::size_t>(j)];
      const bool prior = std::isfinite(p.prior_sd);
      scale_[j] = prior                                    ? p.prior_sd
                  : p.scale == ParameterScale::logarithmic ? 1.0
                                                           : std::max(std::abs(theta[j]), 0.1);
      prior_[j] = prior ? 1.0 : 0.0;
    }
    const VectorXd nothing = VectorXd::Zero(problem.residuals);
    const MatrixXd K =
        estimator::nonlinear::compress_data(problem, nothing, jacobian).R * scale_.asDiagonal();
    record_ = K.transpose() * K;
    condition_ = estimator::nonlinear::identifiability(problem, jacobian, scale_).condition;
  }

  IdentifiabilityReport run() {
    const Index n = scale_.size();
    IdentifiabilityReport out;
    out.condition = condition_;
    out.share.resize(n);
    VectorXd spread(n);
    for (Index j = 0; j < n; ++j) spread[j] = std::sqrt(inverse(prior_).coeff(j, j));
    for (Index j = 0; j < n; ++j) {
      out.share[j] = prior_[j] > 0.0 ? 1.0 - std::min(1.0, spread[j] * spread[j])
                                     : (spread[j] < 1e3 ? 1.0 : 0.0);
    }
    std::vector<Index> order(static_cast<std::size_t>(n));
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return spread[a] > spread[b]; });
    for (const Index j : order) {
      const double limit = prior_[j] > 0.0 ? kHeld : 1.0;
      if (spread[j] < limit || is_partner(out, j)) continue;
      out.unidentifiable.push_back(unseen(j));
    }
    return out;
  }

 private:
  MatrixXd inverse(const VectorXd& priors) const {
    MatrixXd H = record_;
    H.diagonal() += priors;
    // Scaled by each parameter's own weight, so that an invisible one stays invisible.
    const VectorXd unit = (record_.diagonal().array() + priors.array() + 1e-12).rsqrt();
    H = (unit.asDiagonal() * H * unit.asDiagonal()).eval();
    H.diagonal().array() += kRidge;
    const MatrixXd inverse =
        linear_algebra::solve_symmetric(H, MatrixXd(MatrixXd::Identity(H.rows(), H.cols())));
    return unit.asDiagonal() * inverse * unit.asDiagonal();
  }

  /// Without priors a combination leaves several parameters unidentified; it is reported once.
  bool is_partner(const IdentifiabilityReport& out, Index j) const {
    if (prior_[j] > 0.0) return false;
    return std::any_of(out.unidentifiable.begin(), out.unidentifiable.end(),
                       [&](const UnidentifiableParameter& u) {
                         return std::find(u.partners.begin(), u.partners.end(), index(j)) !=
                                u.partners.end();
                       });
  }

  static std::size_t index(Index j) { return static_cast<std::size_t>(j); }

  bool both_logarithmic(Index a, Index b) const {
    return parameters_[index(a)].scale == ParameterScale::logarithmic &&
           parameters_[index(b)].scale == ParameterScale::logarithmic;
  }

  /// Distance that j can move unnoticed when only k follows.
  double hidden_by(Index j, Index k) const {
    const double rest = record_(j, j) - record_(j, k) * record_(j, k) / record_(k, k);
    return 1.0 / std::sqrt(std::max(rest, 1e-18));
  }

  UnidentifiableParameter unseen(Index j) const {
    UnidentifiableParameter out;
    out.parameter = index(j);
    out.has_prior = prior_[j] > 0.0;
    if (!(record_(j, j) * kHeld * kHeld > 1.0)) return out;
    Index best = -1;
    for (Index k = 0; k < scale_.size(); ++k) {
      if (k == j || !(record_(k, k) > 0.0)) continue;
      if (best < 0 || hidden_by(j, k) > hidden_by(j, best)) best = k;
    }
    if (best >= 0 && hidden_by(j, best) > kHeld) {
      const double slope = -record_(j, best) / record_(best, best) * scale_[best] / scale_[j];
      out.cause = UnidentifiableParameter::Cause::one_partner;
      out.partners = {index(best)};
      if (both_logarithmic(j, best)) out.visible = {{index(best), slope}};
      return out;
    }
    out.cause = UnidentifiableParameter::Cause::traded;
    followers(j, out);
    return out;
  }

  void followers(Index j, UnidentifiableParameter& out) const {
    // Weak priors leave the exponents of the equations and still bound the parameters that
    // nothing else determines.
    VectorXd others = kWeak * prior_;
    others[j] = 0.0;
    const VectorXd column = inverse(others).col(j);
    std::vector<std::pair<double, Index>> moved;
    for (Index k = 0; k < column.size(); ++k) {
      if (k == j) continue;
      // Relative to the distance of k alone that the record would notice.
      const double noticed = std::abs(column[k] / column[j]) * std::sqrt(record_(k, k));
      if (noticed > 1.0) moved.push_back({noticed, k});
    }
    std::sort(moved.begin(), moved.end(), std::greater<>());
    bool products = !moved.empty() && moved.size() <= kMostPartners;
    for (const auto& [noticed, k] : moved) {
      if (out.partners.size() == kMostPartners) break;
      out.partners.push_back(index(k));
      products = products && both_logarithmic(j, k);
    }
    if (!products) return;
    for (const auto& [noticed, k] : moved) {
      out.visible.push_back({index(k), column[k] / column[j] * scale_[k] / scale_[j]});
    }
  }

  const std::vector<FreeParameter>& parameters_;
  VectorXd scale_;
  VectorXd prior_;  ///< precision in scaled units: 1; 0 without prior
  MatrixXd record_;
  double condition_ = 0.0;
};

}  // namespace

IdentifiabilityReport identifiability_report(const estimator::nonlinear::Problem& problem,
                                             const MatrixXd& jacobian,
                                             const std::vector<FreeParameter>& parameters,
                                             const VectorXd& theta) {
  return IdentifiabilityAnalysis(problem, jacobian, parameters, theta).run();
}

void derivatives(const estimator::nonlinear::Problem& problem, const VectorXd& theta,
                 VectorXd& residual, MatrixXd& jacobian) {
  using estimator::nonlinear::DifferenceStep;
  std::vector<Index> columns(static_cast<std::size_t>(theta.size()));
  std::iota(columns.begin(), columns.end(), 0);
  const std::vector<DifferenceStep> probes = probes_at(problem, theta, columns, false);
  MatrixXd points(theta.size(), static_cast<Index>(probes.size()) + 1);
  points.col(0) = theta;
  points.rightCols(static_cast<Index>(probes.size())) = points_at(theta, probes, 0, probes.size());
  estimator::nonlinear::Groups groups(problem);
  const MatrixXd results = groups.run(points);
  residual = results.col(0);
  jacobian.setZero(problem.residuals, theta.size());
  fill_columns(problem, theta, residual, probes,
               results.rightCols(static_cast<Index>(probes.size())), groups, jacobian);
}

}  // namespace estimator::greybox
