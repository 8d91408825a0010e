#include "workbench/scorecard/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/residual/special.h"

namespace workbench::scorecard {
namespace {

constexpr double kRounding = 1e-9;
constexpr int kHalvings = 60;

/// P(X >= k), X binomial.
double at_least(std::int64_t k, std::int64_t n, double p) {
  double sum = 0.0;
  for (std::int64_t i = k; i <= n; ++i) {
    const auto x = static_cast<double>(i);
    const auto m = static_cast<double>(n);
    const double ways = std::lgamma(m + 1.0) - std::lgamma(x + 1.0) - std::lgamma(m - x + 1.0);
    const double missed = i == n ? 0.0 : (m - x) * std::log1p(-p);
    sum += std::exp(ways + x * std::log(p) + missed);
  }
  return sum;
}

}  // namespace

double poisson_upper(std::int64_t events, double time, double confidence) {
  if (!(time > 0.0)) return std::numeric_limits<double>::infinity();
  const double dof = 2.0 * static_cast<double>(events) + 2.0;
  return estimator::residual::chi_square_quantile_upper(1.0 - confidence, dof) / (2.0 * time);
}

double clopper_pearson_lower(std::int64_t k, std::int64_t n, double confidence) {
  if (k <= 0) return 0.0;
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double p = 0.5 * (low + high);
    (at_least(k, n, p) < 1.0 - confidence ? low : high) = p;
  }
  return 0.5 * (low + high);
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(share * static_cast<double>(values.size()) - kRounding);
  const auto at = static_cast<std::size_t>(std::max(1.0, rank)) - 1;
  return values[std::min(at, values.size() - 1)];
}

bool enough(std::int64_t k, std::int64_t n, double share) {
  return static_cast<double>(k) >= share * static_cast<double>(n) - kRounding;
}

}  // namespace workbench::scorecard
