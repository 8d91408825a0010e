// Residual that remains when a model's parameters adjust linearly against their priors, and one
// further signature enters with any strength.
//
//   cost = min_{a,b} |r + J a + d b|^2 / s^2 + sum ((theta + a - mean) / sd)^2
//
// a adjustments of the parameters from theta, where r is; a signature is credited with the prior
// cost that it removes.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <utility>

#include "estimator/greybox/fit.h"

namespace estimator::greybox::selection {

class Projection {
 public:
  /// Projection of a fitted model over the samples with `weights` 1 (0: ignored).
  Projection(const FitSummary& fitted, const Eigen::VectorXd& weights);

  /// With the fitted model's own residual and no signature.
  [[nodiscard]] double cost() const { return cost_; }
  /// With the residual of the parameters at `theta`, whose first entries are the fitted model's.
  [[nodiscard]] double remaining(const Eigen::Ref<const Eigen::VectorXd>& residual_m,
                                 const Eigen::Ref<const Eigen::VectorXd>& theta) const;
  /// Cost and b with such a residual and a signature, both as long as the weights.
  [[nodiscard]] std::pair<double, double> with(
      const Eigen::Ref<const Eigen::VectorXd>& residual_m,
      const Eigen::Ref<const Eigen::VectorXd>& theta,
      const Eigen::Ref<const Eigen::VectorXd>& signature_m) const;
  /// The same with two signatures.
  struct Two {
    double cost;
    double first;
    double second;
  };
  [[nodiscard]] Two with(const Eigen::Ref<const Eigen::VectorXd>& residual_m,
                         const Eigen::Ref<const Eigen::VectorXd>& theta,
                         const Eigen::Ref<const Eigen::VectorXd>& first_m,
                         const Eigen::Ref<const Eigen::VectorXd>& second_m) const;
  /// The signature less the part that the parameters can imitate.
  [[nodiscard]] Eigen::VectorXd beyond(const Eigen::Ref<const Eigen::VectorXd>& signature_m) const;

 private:
  /// A series beside the parameters' distances from their priors, and its part in their space.
  struct Weighed {
    Eigen::VectorXd series;
    Eigen::VectorXd strain;
    Eigen::VectorXd onto;
  };
  [[nodiscard]] Weighed residual(const Eigen::Ref<const Eigen::VectorXd>& residual_m,
                                 const Eigen::Ref<const Eigen::VectorXd>& theta) const;
  [[nodiscard]] Weighed signature(const Eigen::Ref<const Eigen::VectorXd>& signature_m) const;
  /// Product of what the parameters leave of two.
  [[nodiscard]] double left(const Weighed& one, const Weighed& other) const;

  Eigen::VectorXd weights_;
  Eigen::MatrixXd weighted_jacobian_;  ///< divided by s, counted samples only
  Eigen::MatrixXd jacobian_;
  Eigen::LLT<Eigen::MatrixXd> normal_;
  Eigen::VectorXd prior_mean_;
  Eigen::VectorXd per_prior_sd_;  ///< 0: no prior
  double per_sigma_ = 0.0;
  double cost_ = 0.0;
};

}  // namespace estimator::greybox::selection
