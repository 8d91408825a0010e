// Autocovariance of a residual and the autoregression that describes it.
//
//   e(t) = sum_k a_k e(t-k) + w(t), w white;   order by least n ln var(w) + order ln n
//
// The mean is not removed: a residual's mean is part of its error. NaN marks a missing sample; lags
// are averaged over the pairs that exist.
// Effective samples: n var(e) / (spectral density of e at frequency 0) = n var(e) (1 - sum a)^2 /
// var(w), at most n: the number of independent samples with the same variance of the mean.
// Source: P. J. Brockwell, R. A. Davis, Time Series: Theory and Methods, chapters 5, 8 and 9
// (Levinson-Durbin recursion, order selection).
#pragma once

#include <span>
#include <vector>

namespace estimator::residual {

/// Lags 0..max_lag, the unit of the series squared. 0 where no pair exists.
[[nodiscard]] std::vector<double> autocovariance(std::span<const double> series, int max_lag);

struct Autoregression {
  std::vector<double> a;  ///< empty: white
  double variance = 0.0;  ///< variance of the series about 0
  double innovation_variance = 0.0;
  int samples = 0;

  [[nodiscard]] double effective_samples() const;
};

[[nodiscard]] Autoregression fit_autoregression(std::span<const double> series, int max_order = 20);

/// w(t); NaN where it or one of the samples before it is missing.
[[nodiscard]] std::vector<double> whiten(std::span<const double> series,
                                         const Autoregression& model);

}  // namespace estimator::residual
