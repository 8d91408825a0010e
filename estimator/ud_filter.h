// Bierman's measurement update of P = U D U' (U unit upper triangular, D > 0): information only
// enters through sums of positive terms, so P stays positive definite whatever the rounding.
//
//   f = U' psi,  v_j = D_j f_j,  alpha_0 = r,  alpha_j = alpha_{j-1} + f_j v_j,
//   D_j <- D_j alpha_{j-1} / alpha_j,   for i < j: U_ij <- U_ij - f_j / alpha_{j-1} b_i,
//   b_i <- b_i + U_ij v_j (old U_ij),  b_j = v_j,   gain = b / alpha_p
//
// r: variance of the measurement noise, psi: measured direction.
// Source: G. J. Bierman, Factorization Methods for Discrete Sequential Estimation, 1977, chapter V.
#pragma once

#include "estimator/givens_update.h"

namespace estimator {

/// U by columns (U(i, j) at unit[padded(size) * j + i], 0 in place of the diagonal's 1) and D.
struct UdFactor {
  alignas(16) double unit[padded(kMaxCoefficients) * kMaxCoefficients];
  alignas(16) double d[padded(kMaxCoefficients)];
};

struct UdUpdate {
  /// Measures psi' theta with variance `r`, then divides P by `forgetting`. `gain` (padded)
  /// receives b;
  /// returns alpha_p = r + psi' P psi, so that theta += b e / alpha_p. Changes nothing when alpha_p
  /// is not finite.
  double (*measure)(UdFactor& p, const double* psi, double r, double forgetting,
                    double* gain) noexcept;
  /// Adds `information` about coefficient `i` alone.
  void (*add_information)(UdFactor& p, int i, double information) noexcept;
};

/// The update compiled for this number of coefficients, 1 to kMaxCoefficients.
[[nodiscard]] const UdUpdate& ud_update(int size) noexcept;

}  // namespace estimator
