#include "workbench/scorecard/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/residual/distributions.h"

namespace workbench::scorecard {
namespace {

constexpr double kRounding = 1e-9;

}  // namespace

double poisson_upper(std::int64_t events, double time, double confidence) {
  if (!(time > 0.0)) return std::numeric_limits<double>::infinity();
  const double dof = 2.0 * static_cast<double>(events) + 2.0;
  return estimator::residual::chi_square_quantile_upper(1.0 - confidence, dof) / (2.0 * time);
}

double clopper_pearson_lower(std::int64_t k, std::int64_t n, double confidence) {
  if (k <= 0) return 0.0;
  return estimator::residual::beta_quantile(1.0 - confidence, static_cast<double>(k),
                                            static_cast<double>(n - k) + 1.0);
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
