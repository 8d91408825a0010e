// Bounded, weighted, Bayesian non-linear least squares: the problem.
//
//   cost(x) = sum_i w_i r_i(x)^2 / sigma^2 + sum_j ((x_j - prior_mean_j) / prior_sd_j)^2,
//   lower_j <= x_j <= upper_j
//
//   r      residuals, any unit; sigma: standard deviation of their noise, same unit
//   w      weight of a squared residual: 0 leaves it out (it may then be NaN)
//   x      search variables in the caller's scale, for example logarithms of positive quantities;
//          bounds, steps and priors are in that scale
//
// With sigma right, cost is a chi-square: minus twice the logarithm of likelihood times prior.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <vector>

#include "config/signals/nan.h"

namespace estimator::nonlinear {

using config::signals::kNaN;

struct Unknown {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();  ///< lower == upper: held there
  double step = 0.0;            ///< finite-difference step: max(step, relative_step |x|)
  double relative_step = 1e-7;  ///< used alone where step is 0
  double prior_mean = kNaN;     ///< NaN: none
  double prior_sd = std::numeric_limits<double>::infinity();  ///< infinite or NaN: none
  double max_step = std::numeric_limits<double>::infinity();  ///< largest move in one iteration

  [[nodiscard]] bool has_prior() const {
    return prior_mean == prior_mean && prior_sd > 0.0 &&
           prior_sd < std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] bool is_held() const { return !(lower < upper); }
};

/// Residuals of several parameter sets at once. `points` has one column per set, at most
/// Problem::lanes of them; `residuals` is sized residuals x columns and to be filled. A set that
/// cannot be evaluated gets a NaN anywhere in its column.
using Evaluate = std::function<void(const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals)>;

struct Problem {
  Eigen::Index residuals = 0;
  std::vector<Unknown> unknowns;
  Evaluate evaluate;
  Eigen::Index lanes = 8;   ///< sets that one call evaluates for about the price of one
  double sigma = 1.0;       ///< > 0
  Eigen::VectorXd weights;  ///< one per residual, >= 0; empty: all 1

  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(unknowns.size()); }
  [[nodiscard]] double weight(Eigen::Index i) const { return weights.size() ? weights[i] : 1.0; }
};

/// The cost above. Infinite when a residual that counts is not finite.
[[nodiscard]] double cost_of(const Problem& problem, const Eigen::VectorXd& x,
                             const Eigen::Ref<const Eigen::VectorXd>& residual);

/// sqrt(sum w r^2 / sum w), the unit of r.
[[nodiscard]] double rms_of(const Problem& problem,
                            const Eigen::Ref<const Eigen::VectorXd>& residual);

}  // namespace estimator::nonlinear
