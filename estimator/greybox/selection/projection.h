// Residual that remains when a model's parameters adjust linearly against their priors, and one
// further signature enters with any strength.
//
//   cost = min_{a,b} |r + J a + d b|^2 / s^2 + sum (a / sd)^2
//
// a adjustments of the parameters, held by their prior widths about the present values.
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
  /// With another residual; its prior is that of the fitted model.
  [[nodiscard]] double remaining(const Eigen::Ref<const Eigen::VectorXd>& residual_m) const;
  /// Cost and b with another residual (its prior is that of the fitted model) and a signature, both
  /// as long as the weights.
  [[nodiscard]] std::pair<double, double> with(
      const Eigen::Ref<const Eigen::VectorXd>& residual_m,
      const Eigen::Ref<const Eigen::VectorXd>& signature_m) const;
  /// The same with two signatures.
  struct Two {
    double cost;
    double first;
    double second;
  };
  [[nodiscard]] Two with(const Eigen::Ref<const Eigen::VectorXd>& residual_m,
                         const Eigen::Ref<const Eigen::VectorXd>& first_m,
                         const Eigen::Ref<const Eigen::VectorXd>& second_m) const;
  /// The signature less the part that the parameters can imitate.
  [[nodiscard]] Eigen::VectorXd beyond(const Eigen::Ref<const Eigen::VectorXd>& signature_m) const;

 private:
  [[nodiscard]] double remaining(const Eigen::VectorXd& weighted, const Eigen::VectorXd& onto,
                                 const Eigen::VectorXd& other,
                                 const Eigen::VectorXd& other_onto) const;

  Eigen::VectorXd weights_;
  Eigen::MatrixXd weighted_jacobian_;  ///< divided by s, counted samples only
  Eigen::MatrixXd jacobian_;
  Eigen::LLT<Eigen::MatrixXd> normal_;
  double per_sigma_ = 0.0;
  double cost_ = 0.0;
};

}  // namespace estimator::greybox::selection
