// The problem linearised at a point, compressed to a triangle, and its damped minimiser in a box.
//
//   cost(x + s) ~ rest + |R s + q|^2:  Householder QR of the rows [sqrt(w) J / sigma | sqrt(w) r /
//   sigma], a block of rows at a time, the priors' rows last
//
//   step(lambda) = argmin |R s + q|^2 + lambda |D s|^2,  low <= s <= high
//
// solved by a primal active-set method: exact, and finite because the objective is strictly convex.
// Sources: J. Nocedal, S. J. Wright, Numerical Optimization, chapters 10 and 16; C. L. Lawson,
// R. J. Hanson, Solving Least Squares Problems, chapter 23.
#pragma once

#include <Eigen/Core>

#include "estimator/nonlinear/problem.h"

namespace estimator::nonlinear {

struct LinearModel {
  Eigen::MatrixXd R;  ///< unknowns x unknowns, upper triangular
  Eigen::VectorXd q;
  double rest = 0.0;  ///< the cost that no step removes
};

/// The data alone: no prior.
[[nodiscard]] LinearModel compress_data(const Problem& problem, const Eigen::VectorXd& residual,
                                        const Eigen::MatrixXd& jacobian);

/// Data and priors, seen from x.
[[nodiscard]] LinearModel compress(const Problem& problem, const Eigen::VectorXd& x,
                                   const Eigen::VectorXd& residual,
                                   const Eigen::MatrixXd& jacobian);

/// `scale`: the diagonal of D, > 0. low <= 0 <= high.
[[nodiscard]] Eigen::VectorXd box_step(const LinearModel& model, const Eigen::VectorXd& scale,
                                       double lambda, const Eigen::VectorXd& low,
                                       const Eigen::VectorXd& high);

/// cost(x) - cost(x + step) of the linear model.
[[nodiscard]] double predicted_decrease(const LinearModel& model, const Eigen::VectorXd& step);

}  // namespace estimator::nonlinear
