// From a triangular factor of the rows [psi y] to the estimate: coefficients, standard errors and
// condition number.
//
//   [psi y] ~ [R z; 0 rho],   theta = R^-1 z,   s^2 = rho^2 / (rows - p),
//   cov theta = s^2 R^-1 R^-T,   condition = cond_2(R S), S scaling its columns to length 1
//
// Source: G. H. Golub, C. F. Van Loan, Matrix Computations, chapter 5.
#pragma once

#include <Eigen/Core>

#include "estimator/estimate.h"
#include "estimator/square_root_information.h"

namespace estimator {

/// Square matrix of at most kMaxColumns, without heap memory.
using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxColumns,
                            kMaxColumns>;

/// D^(1/2) U.
[[nodiscard]] Small triangle(const SquareRootInformation& factor) noexcept;

/// 2-norm condition of the upper triangle with its columns scaled to unit length; infinite when
/// singular.
[[nodiscard]] double scaled_condition(const Small& upper) noexcept;

/// Inverse of an upper triangle without zero on its diagonal.
[[nodiscard]] Small inverse(const Small& upper) noexcept;

/// `augmented`: the triangle of the rows [psi y]. Where the coefficients are not separately
/// determined, `value` is the shortest solution in scaled columns, with NaN standard errors, and
/// the estimate invalid.
[[nodiscard]] Estimate solve(const Small& augmented, int rows, const Limits& limits) noexcept;

}  // namespace estimator
