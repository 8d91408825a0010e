// The same 60 s through batch least squares over whole periods and through recursive least squares:
// cost J of the free run, and mean, greatest offset and variance of b1.
//
// The source prints neither the start nor the weights of its recursion. Both starts are shown; the
// forgetting factor is solved so that the greatest offset is the printed one, and the printed
// variance then judges it.
#include <algorithm>
#include <cmath>
#include <vector>

#include "estimator/batch.h"
#include "estimator/free_run.h"
#include "estimator/recursive.h"
#include "workbench/reproduce/experiment.h"
#include "workbench/reproduce/stand.h"
#include "workbench/reproduce/text.h"
#include "workbench/reproduce/tolerance.h"

namespace workbench::reproduce {
namespace {

using estimator::Structure;

constexpr double kPrintedOffset = 3.1607e-7;
constexpr double kPriorVariance = 1e8;

struct Spread {
  double mean;
  double offset;  ///< greatest distance from the mean
  double variance;
};

Spread spread(const std::vector<double>& values) {
  Spread out{0.0, 0.0, 0.0};
  const auto n = static_cast<double>(values.size());
  for (const double v : values) out.mean += v / n;
  for (const double v : values) {
    out.offset = std::max(out.offset, std::abs(v - out.mean));
    out.variance += (v - out.mean) * (v - out.mean) / n;
  }
  return out;
}

struct Result {
  double cost_m2 = 0.0;       ///< J, free run in step
  double cost_late_m2 = 0.0;  ///< the same read one sample late
  Spread b1{};                ///< after the first period
};

/// One estimate and one free run for each period, each from measured start.
Result batch(const Structure& structure, const Record& record) {
  const auto periods = estimator::fit_periods(structure, record.u_V, record.y_m, kPeriod);
  Result result;
  std::vector<double> b1;
  for (std::size_t i = 0; i < periods.size(); ++i) {
    const auto u_V = record.u(i * kPeriod, kPeriod);
    const auto y_m = record.y(i * kPeriod, kPeriod);
    const auto simulated = estimator::free_run(
        structure, std::span(periods[i].value).first(structure.size()), u_V, y_m);
    result.cost_m2 += estimator::compare(y_m, simulated).cost_m2;
    result.cost_late_m2 += estimator::compare(y_m, simulated, 0, 1).cost_m2;
    if (i > 0) b1.push_back(periods[i].value[1]);
  }
  result.b1 = spread(b1);
  return result;
}

/// One estimate each sample; the free run uses each as it comes.
Result recursive(const Record& record, double forgetting, bool warm) {
  estimator::RecursiveConfig config;
  config.structure = estimator::parse_structure("arx111");
  config.forgetting = forgetting;
  config.prior_variance = kPriorVariance;
  config.warmup = warm ? static_cast<int>(kPeriod) : 0;
  estimator::Recursive estimator(config);
  Result result;
  std::vector<double> b1;
  const std::size_t start = warm ? kPeriod : 0;
  double simulated_m = record.y_m[start];
  estimator.push(record.u_V[0], record.y_m[0]);
  for (std::size_t k = 1; k < record.y_m.size(); ++k) {
    estimator.push(record.u_V[k], record.y_m[k]);
    const double* theta = estimator.coefficients();
    if (k > start) {
      const double before_m = simulated_m;
      simulated_m = -theta[0] * simulated_m + theta[1] * record.u_V[k - 1];
      const double y_m = record.y_m[k];
      result.cost_m2 += (y_m - simulated_m) * (y_m - simulated_m);
      result.cost_late_m2 += (y_m - before_m) * (y_m - before_m);
    }
    if (k >= kPeriod) b1.push_back(theta[1]);
  }
  result.b1 = spread(b1);
  return result;
}

/// The forgetting factor that gives the printed greatest offset, by bisection: less memory, more
/// offset.
double solve_forgetting(const Record& record) {
  double low = 0.95;
  double high = 0.999;
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (low + high);
    (recursive(record, middle, true).b1.offset > kPrintedOffset ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void add_recursive(std::vector<Row>& rows, const std::string& name, const Result& result,
                   const char* spread_rule) {
  rows.push_back(judged(name + ": J, in step, m2", 4.277e-5, result.cost_m2, "recursive cost",
                        text("one sample out of step %.4g", result.cost_late_m2)));
  rows.push_back(judged(name + ": mean b1, m/V", 1.9672e-4, result.b1.mean, "mean b1, recursive"));
  rows.push_back(
      judged(name + ": greatest offset of b1, m/V", kPrintedOffset, result.b1.offset, spread_rule));
  rows.push_back(
      judged(name + ": variance of b1, (m/V)2", 2.7153e-14, result.b1.variance, spread_rule));
}

}  // namespace

std::vector<Row> batch_against_recursive() {
  const Record record = run(calibrated(), 60.0);
  std::vector<Row> rows;
  const Result whole = batch(estimator::parse_structure("arx111"), record);
  rows.push_back(judged("batch: J, in step, m2", 9.1157e-4, whole.cost_m2, "cost, in step",
                        "sum over all 30 periods, the first with its start-up included"));
  rows.push_back(judged("batch: J, one sample out of step, m2", 9.1157e-4, whole.cost_late_m2,
                        "cost, out of step", "as E: the guess that comes close"));
  rows.push_back(judged("batch: mean b1, m/V", 1.9672e-4, whole.b1.mean, "mean b1"));
  rows.push_back(judged("batch: greatest offset of b1, m/V", 4.193e-9, whole.b1.offset, "spread",
                        "periods 2 to 30; a steady noise-free loop repeats itself more exactly"));
  rows.push_back(judged("batch: variance of b1, (m/V)2", 2.2131e-18, whole.b1.variance, "spread",
                        "as the offset"));
  add_recursive(rows, "recursive, P(0) = 1e8 I, no forgetting", recursive(record, 1.0, false),
                "spread");
  add_recursive(rows, "recursive, warm start, no forgetting", recursive(record, 1.0, true),
                "spread");
  const double forgetting = solve_forgetting(record);
  const Result solved = recursive(record, forgetting, true);
  add_recursive(rows, text("recursive, warm start, forgetting %.4f (solved)", forgetting), solved,
                "spread, recursive");
  rows.push_back(judged("variance of b1, recursive over batch", 1.2269e4,
                        solved.b1.variance / whole.b1.variance, "magnitude"));
  rows.push_back(judged("J, recursive over batch (in step)", 4.277e-5 / 9.1157e-4,
                        solved.cost_m2 / whole.cost_m2, "recursive cost is smaller",
                        "in step the batch has no delay to pay for"));
  rows.push_back(judged("J, recursive in step over batch out of step", 4.277e-5 / 9.1157e-4,
                        solved.cost_m2 / whole.cost_late_m2, "recursive cost is smaller"));
  return rows;
}

}  // namespace workbench::reproduce
