#include "estimator/spectra/autocorrelation.h"

#include <cmath>

#include "config/signals/nan.h"

namespace estimator::spectra {

Autocorrelation autocorrelation(std::span<const double> series, std::size_t lags) {
  constexpr double kTwoSided95 = 1.96;
  double sum = 0.0;
  double count = 0.0;
  for (const double x : series) {
    if (!std::isfinite(x)) continue;
    sum += x;
    ++count;
  }
  const double mean = sum / count;
  Autocorrelation out;
  out.white_bound = kTwoSided95 / std::sqrt(count);
  double variance = 0.0;
  for (std::size_t lag = 0; lag <= lags; ++lag) {
    double products = 0.0;
    double pairs = 0.0;
    for (std::size_t k = 0; k + lag < series.size(); ++k) {
      const double product = (series[k] - mean) * (series[k + lag] - mean);
      if (!std::isfinite(product)) continue;
      products += product;
      ++pairs;
    }
    if (lag == 0) variance = products / pairs;
    out.value.push_back(pairs > 0.0 && variance > 0.0 ? products / pairs / variance
                                                      : config::signals::kNaN);
  }
  return out;
}

}  // namespace estimator::spectra
