// Parameters that the data can distinguish, before a fit (Jacobian at the start) and after it.
//
//   scaled Jacobian  K = sqrt(W) J diag(scale) / sigma = U S V'
//
// `scale` is the change of each unknown that would matter (a prior's standard deviation; 1 for a
// logarithm). Along a direction v the data leave an uncertainty 1 / |K v| in those units: where
// that exceeds `limit` the data do not see v. In logarithms v = (0.45 gain, -0.89 Ps) unseen says
// that only gain * sqrt(Ps) is visible. The unseen directions are turned within their space
// (elimination with pivoting) so that each involves as few unknowns as can be. Source: G. A. F.
// Seber, C. J. Wild, Nonlinear Regression, 3.4; K. Z. Yao et al., Polymer Reaction Engineering 11
// (2003) 563.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/nonlinear/problem.h"

namespace estimator::nonlinear {

struct Term {
  Eigen::Index unknown = 0;
  double weight = 0.0;  ///< change in units of its scale; a combination's squares sum to about 1
};

struct Combination {
  std::vector<Term> terms;   ///< largest first; those below 0.1 are left out
  double uncertainty = 0.0;  ///< 1 / |K v|, in scales; infinite: invisible
  std::vector<Term>
      visible;  ///< with two terms: the combination of the two that the data determine
};

struct Identifiability {
  Eigen::VectorXd singular_values;  ///< singular values of K, largest first; held unknowns left out
  double condition = 0.0;           ///< condition of K with its columns scaled to length 1
  Eigen::VectorXd alone;            ///< std error in scales if all others were known; NaN: held
  Eigen::VectorXd together;         ///< std error in scales with all unknown; NaN: held
  std::vector<Combination> unseen;
};

struct IdentifiabilityOptions {
  double limit = 1.0;        ///< uncertainty, in scales, above which a direction is invisible
  bool with_priors = false;  ///< true: data and priors together
};

/// `jacobian` as in Solution: residuals x unknowns. `scale` > 0, one per unknown.
[[nodiscard]] Identifiability identifiability(const Problem& problem,
                                              const Eigen::MatrixXd& jacobian,
                                              const Eigen::VectorXd& scale,
                                              const IdentifiabilityOptions& options = {});

}  // namespace estimator::nonlinear
