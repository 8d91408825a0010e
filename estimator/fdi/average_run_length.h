// Average run length: mean number of values before a test raises a false alarm, and the thresholds
// for a required number. The values are independent, z ~ N(shift, 1).
//
//   CUSUM  S = max(0, S + z - k), alarm at S >= h; two-sided: one each for z and -z,
//          1/ARL = 1/ARL+ + 1/ARL-
//   The chain of S over m equal states on [0, h) has an exact linear equation for its mean time to
//   absorption; m = 101 agrees with the integral equation to 1 %.
//   Source: D. Brook, D. A. Evans, Biometrika 59 (1972) 539; two-sided: K. W. Kemp, 1961.
//
//   GLR    max over the last n <= W values of |sum z| / sqrt(n) >= b
//          ARL = sqrt(2 pi) exp(b^2/2) / (b int x nu(x)^2 dx), x from b/sqrt(W) to b
//          nu(x) = (2/x)(Phi(x/2) - 1/2) / ((x/2) Phi(x/2) + phi(x/2))
//   Asymptotic for large b; simulated runs were 0.83 to 0.98 as long for ARL 200 to 10000 and W of
//   20 and 64, so the threshold is set for 1.2 times the required length. W = 1 is exact.
//   Source: D. Siegmund, E. S. Venkatraman, Annals of Statistics 23 (1995) 255.
//
// Correlated values: over long runs a CUSUM responds only to their long-run variance, variance
// (1 + 2 sum of autocorrelations), so the values are standardised by that (R. A. Johnson, M.
// Bagshaw, Technometrics 16 (1974) 103), after averaging over blocks as long as an estimator's
// window. Simulated runs are longer than stated then: 1.2 to 1.5 times for blocks of one window, 2
// to 7 times for first-order correlations of 0.3 to 0.6 left between them.
#pragma once

namespace estimator::fdi {

/// Average run length of a one-sided CUSUM from S = 0; k and h in standard deviations, h > 0.
[[nodiscard]] double cusum_run_length(double k, double h, double shift = 0.0);
/// Threshold h of a two-sided CUSUM whose mean is wrong by `mean_error` to either side.
[[nodiscard]] double cusum_threshold(double k, double run_length, double mean_error = 0.0);

/// `window`: W, at least 1.
[[nodiscard]] double glr_run_length(double b, int window);
/// b; a mean wrong by `mean_error` may add mean_error sqrt(W) to the statistic.
[[nodiscard]] double glr_threshold(double run_length, int window, double mean_error = 0.0);

}  // namespace estimator::fdi
