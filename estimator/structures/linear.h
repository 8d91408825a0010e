// Linear least squares for the start values of the non-linear fits, by pivoted orthogonal
// factorisation.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/structures/polynomial.h"

namespace estimator::structures {

/// The rows psi(t) = [-y(t-1).., u(t-k).., e(t-1).., 1] of all stretches, and their targets y(t).
struct Rows {
  Eigen::MatrixXd psi;
  Eigen::VectorXd target;
};

/// `orders` with a, b, c, k and constant in use. `errors`: one series per stretch, needed for c;
/// NaN at its beginning (rows that reach there are left out).
[[nodiscard]] Rows regression_rows(const Orders& orders, const Stretches& data,
                                   const std::vector<std::vector<double>>& errors = {});

/// The shortest minimiser (columns scaled to length 1) of |target - psi theta|.
[[nodiscard]] Eigen::VectorXd solve_rows(const Rows& rows);

/// ARX by least squares; A, B and the constant.
[[nodiscard]] Polynomial fit_arx(const Orders& orders, const Stretches& data);

}  // namespace estimator::structures
