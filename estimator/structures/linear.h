// Linear least squares for the start values of the non-linear fits, by pivoted orthogonal
// factorisation.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/structures/polynomial.h"

namespace estimator::structures {

/// The rows psi(t) = [-y(t-1).., u(t-k).., e(t-1).., 1] of all stretches, and their targets y(t).
struct RegressionRows {
  Eigen::MatrixXd psi;
  Eigen::VectorXd target;
};

/// `orders` with a, b, c, k and constant in use. `errors`: one series per stretch, needed for c;
/// NaN at its beginning (rows that reach there are left out).
[[nodiscard]] RegressionRows regression_rows(const Orders& orders, const Stretches& data,
                                             const std::vector<std::vector<double>>& errors = {});

/// RMS of u (V) or of y (m) over all stretches; 0 without samples.
[[nodiscard]] double rms(const Stretches& data, bool of_input);

/// The shortest minimiser (columns scaled to length 1) of |target - psi theta|.
[[nodiscard]] Eigen::VectorXd solve_rows(const RegressionRows& rows);

/// ARX by least squares; A, B and the constant.
[[nodiscard]] Polynomial fit_arx(const Orders& orders, const Stretches& data);

/// Starting points of the prediction-error minimisation: consistent or nearly so, without iteration
/// or with a linear one, because the criterion has local minima.
///
///   ARMAX        Hannan-Rissanen: errors of a long ARX as if known, then linear least squares
///   output error ARX's A as F; Steiglitz-McBride: ARX on u and y filtered by 1/F, repeated
///   Box-Jenkins  F and B of an output-error fit with C, D of an ARMA model of its error, and
///                ARMAX's A as both F and D
///
/// Sources: E. J. Hannan, J. Rissanen, Biometrika 69 (1982) 81; K. Steiglitz, L. E. McBride, IEEE
/// Trans. AC-10 (1965) 461; L. Ljung, System Identification, 10.5.
/// A, B, C and the constant of `orders`; D and F empty.
[[nodiscard]] Polynomial hannan_rissanen(const Orders& orders, const Stretches& data);

/// B, F and the constant of `orders`; the last iterate and those before, best unknown.
[[nodiscard]] std::vector<Polynomial> steiglitz_mcbride(const Orders& orders,
                                                        const Stretches& data);

/// C and D of  D v = C e  for series v; `d` and `c` coefficients.
struct ArmaModel {
  std::vector<double> c;
  std::vector<double> d;
};
[[nodiscard]] ArmaModel fit_noise(const std::vector<std::vector<double>>& series, int c, int d);

/// Roots outside the unit circle (or nearer to it than `margin`) are drawn inside.
[[nodiscard]] std::vector<double> stabilised(const std::vector<double>& p, double margin);

}  // namespace estimator::structures
