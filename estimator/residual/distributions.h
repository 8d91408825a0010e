// Tail probabilities and quantiles of the test statistics' distributions.
//
//   chi-square   P(X > x) = Q(dof/2, x/2), the regularised upper incomplete gamma function
//   Student t    P(|T| > |t|) = I_{dof/(dof + t^2)}(dof/2, 1/2), the incomplete beta function
//   Fisher F     P(X > x) = I_{dof2/(dof2 + dof1 x)}(dof2/2, dof1/2)
//   beta         P(X < x) = I_x(a, b)
//
// Boost.Math computes them; only distributions.cpp includes its headers.
#pragma once

namespace estimator::residual {

/// dof > 0; 1 for x <= 0; NaN for NaN.
[[nodiscard]] double chi_square_upper(double x, double dof);
[[nodiscard]] double student_two_sided(double t, double dof);

/// x with P(X > x) = p, 0 < p < 1.
[[nodiscard]] double chi_square_quantile_upper(double p, double dof);
[[nodiscard]] double f_quantile_upper(double p, double dof1, double dof2);

/// x with P(X < x) = p, 0 < p < 1.
[[nodiscard]] double beta_quantile(double p, double a, double b);

}  // namespace estimator::residual
