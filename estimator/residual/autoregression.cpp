#include "estimator/residual/autoregression.h"

#include <algorithm>
#include <cmath>

#include "config/signals/nan.h"

namespace estimator::residual {

using config::signals::kNaN;

std::vector<double> autocovariance(std::span<const double> series, int max_lag) {
  std::vector<double> out(static_cast<std::size_t>(max_lag) + 1, 0.0);
  for (std::size_t lag = 0; lag < out.size(); ++lag) {
    double sum = 0.0;
    std::size_t pairs = 0;
    for (std::size_t t = lag; t < series.size(); ++t) {
      const double product = series[t] * series[t - lag];
      if (std::isnan(product)) continue;
      sum += product;
      ++pairs;
    }
    if (pairs > 0) out[lag] = sum / static_cast<double>(pairs);
  }
  return out;
}

double Autoregression::effective_samples() const {
  if (!(innovation_variance > 0.0)) return samples;
  double sum = 1.0;
  for (const double value : a) sum -= value;
  return std::clamp(samples * variance * sum * sum / innovation_variance, 1.0,
                    std::max(1.0, static_cast<double>(samples)));
}

Autoregression fit_autoregression(std::span<const double> series, int max_order) {
  Autoregression out;
  out.samples = static_cast<int>(
      std::count_if(series.begin(), series.end(), [](double v) { return v == v; }));
  max_order = std::max(0, std::min(max_order, out.samples / 10));
  const std::vector<double> gamma = autocovariance(series, max_order);
  out.variance = out.innovation_variance = gamma[0];
  if (!(gamma[0] > 0.0)) return out;
  const double n = out.samples;
  std::vector<double> a;
  double variance = gamma[0];
  double least = n * std::log(variance);
  for (int order = 1; order <= max_order; ++order) {
    double reflection = gamma[static_cast<std::size_t>(order)];
    for (int k = 1; k < order; ++k) {
      reflection -= a[static_cast<std::size_t>(k - 1)] * gamma[static_cast<std::size_t>(order - k)];
    }
    reflection /= variance;
    if (!(std::abs(reflection) < 1.0)) break;  // gaps can make the covariances contradictory
    std::vector<double> next = a;
    for (int k = 1; k < order; ++k) {
      next[static_cast<std::size_t>(k - 1)] -=
          reflection * a[static_cast<std::size_t>(order - k - 1)];
    }
    next.push_back(reflection);
    a = std::move(next);
    variance *= 1.0 - reflection * reflection;
    const double criterion = n * std::log(variance) + order * std::log(n);
    if (criterion < least) {
      least = criterion;
      out.a = a;
      out.innovation_variance = variance;
    }
  }
  return out;
}

std::vector<double> whiten(std::span<const double> series, const Autoregression& model) {
  std::vector<double> out(series.size(), kNaN);
  for (std::size_t t = model.a.size(); t < series.size(); ++t) {
    double value = series[t];
    for (std::size_t k = 0; k < model.a.size(); ++k) value -= model.a[k] * series[t - 1 - k];
    out[t] = value;
  }
  return out;
}

}  // namespace estimator::residual
