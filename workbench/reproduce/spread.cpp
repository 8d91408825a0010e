#include "workbench/reproduce/spread.h"

#include <algorithm>
#include <cmath>

#include "estimator/batch.h"
#include "estimator/free_run.h"
#include "estimator/recursive.h"

namespace workbench::reproduce {
namespace {

using estimator::Structure;

constexpr double kPriorVariance = 1e8;

/// The free run's next value from its own past and the measured input.
double predict(const Structure& structure, const double* theta, const std::vector<double>& y_m,
               const std::vector<double>& u_V, std::size_t t) {
  double next_m = 0.0;
  for (int i = 0; i < structure.n; ++i) next_m -= theta[i] * y_m[t - 1 - i];
  for (int j = 0; j < structure.m; ++j) next_m += theta[structure.n + j] * u_V[t - structure.k - j];
  return next_m;
}

}  // namespace

Spread spread_of(const std::vector<double>& values) {
  Spread out{0.0, 0.0, 0.0};
  const auto n = static_cast<double>(values.size());
  for (const double v : values) out.mean += v / n;
  for (const double v : values) {
    out.offset = std::max(out.offset, std::abs(v - out.mean));
    out.variance += (v - out.mean) * (v - out.mean) / n;
  }
  return out;
}

JudgedRun judge_batch(const Structure& structure, const ScenarioRecord& record,
                      std::size_t window) {
  const auto estimates = estimator::fit_periods(structure, record.u_V, record.y_m, window);
  JudgedRun out;
  std::vector<double> b1;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    const auto u_V = record.u(i * window, window);
    const auto y_m = record.y(i * window, window);
    const auto simulated = estimator::free_run(
        structure, std::span(estimates[i].value).first(structure.size()), u_V, y_m);
    out.cost_m2 += estimator::compare(y_m, simulated).cost_m2;
    out.cost_late_m2 += estimator::compare(y_m, simulated, 0, 1).cost_m2;
    if (i > 0) b1.push_back(estimates[i].value[structure.n]);
  }
  out.b1 = spread_of(b1);
  return out;
}

JudgedRun judge_recursive(const Structure& structure, const ScenarioRecord& record,
                          double forgetting, bool warm) {
  estimator::RecursiveConfig config;
  config.structure = structure;
  config.forgetting = forgetting;
  config.prior_variance = kPriorVariance;
  config.warmup = warm ? static_cast<int>(kPeriod) : 0;
  estimator::Recursive estimator(config);
  JudgedRun out;
  std::vector<double> b1;
  std::vector<double> simulated_m = record.y_m;  // measured until the first estimate is there
  for (std::size_t t = 0; t < record.y_m.size(); ++t) {
    estimator.push(record.u_V[t], record.y_m[t]);
    const double* theta = estimator.coefficients();
    if (theta[structure.n] == 0.0 || t < static_cast<std::size_t>(structure.history())) continue;
    simulated_m[t] = predict(structure, theta, simulated_m, record.u_V, t);
    out.cost_m2 += std::pow(record.y_m[t] - simulated_m[t], 2);
    out.cost_late_m2 += std::pow(record.y_m[t] - simulated_m[t - 1], 2);
    if (t >= kPeriod) b1.push_back(theta[structure.n]);
  }
  out.b1 = spread_of(b1);
  return out;
}

double forgetting_with_offset(const Structure& structure, const ScenarioRecord& record,
                              double offset) {
  double low = 0.95;
  double high = 0.9999;
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (low + high);
    // Less memory, more offset.
    (judge_recursive(structure, record, middle, true).b1.offset > offset ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace workbench::reproduce
