// Is a residual noise only? Whiteness, and independence from the input, each with a p value: the
// probability of a statistic this large from noise alone.
//
// Whiteness (Ljung-Box):  Q = n (n + 2) sum_{k=1..lags} rho_k^2 / (n - k)  ~ chi-square(lags)
//
// Independence: the whitened residual w(t) is regressed on means of the input over windows that lie
// wholly before t, [t-1], [t-2], [t-4, t-3], [t-8, t-5] ... so that a few numbers reach far back:
//
//   X = (|w|^2 - |w - regression|^2) / s^2  ~ chi-square(rank)
//
// In closed loop the controller feeds y(t), and with it the noise e(t), into u(t), u(t+1) ...: the
// residual correlates with present and later inputs (lags <= 0) also when the model is right, so
// only past inputs (lags >= 1) count. A coloured residual would still correlate with past inputs
// through its own past, which the controller has seen; its innovations w(t) do not. A row's u(t) is
// written after y(t) was read: lag 1 is the first that can act on y(t).
// Sources: G. M. Ljung, G. E. P. Box, Biometrika 65 (1978) 297; T. Soderstrom, P. Stoica, System
// Identification, 11.2; L. Ljung, System Identification, 16.6.
#pragma once

#include <span>

namespace estimator::residual {

struct TestResult {
  double statistic = 0.0;
  double dof = 0.0;
  double p = 1.0;  ///< NaN when there are too few samples
  int worst_lag = 0;
  double worst_correlation = 0.0;  ///< at that lag; independence: with the window ending there
  int samples = 0;
};

/// NaN in a series marks a missing sample. `fitted`: parameters of an autoregression fitted to this
/// very series, taken off the degrees of freedom (0 for a simulated model's residual).
[[nodiscard]] TestResult whiteness(std::span<const double> residual, int lags = 20, int fitted = 0);

/// Both series sampled together; `reach`: number of samples back that the windows cover.
[[nodiscard]] TestResult independence(std::span<const double> residual,
                                      std::span<const double> input, int reach = 128);

}  // namespace estimator::residual
