// Correlation of a series with itself, shifted:
//
//   r(L) = mean over the pairs of (x(k) - mean) (x(k + L) - mean) / variance
//
// A white series of n samples stays within +-1.96 / sqrt(n) at 95 % of the lags.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace estimator::spectra {

struct Autocorrelation {
  std::vector<double> value;  ///< lags 0, 1, ...; NaN where there is no pair
  double white_bound = 0.0;   ///< 95 % of a white series' lags lie within
};

/// NaN marks a missing sample; pairs with one do not count.
[[nodiscard]] Autocorrelation autocorrelation(std::span<const double> series, std::size_t lags);

}  // namespace estimator::spectra
