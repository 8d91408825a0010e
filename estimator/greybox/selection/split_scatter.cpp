#include "estimator/greybox/selection/split_scatter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "estimator/greybox/fit.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kHalfIterations = 10;
/// Distance over its error that chance reaches once in twenty.
constexpr double kClearlyApart = 2.0;

/// The weights of the first or the last samples that count, half of each record's: a parameter may
/// have a value of its own in one of them.
VectorXd half_of(const FitDataset& data, const VectorXd& weights, bool first) {
  const auto weights_of = [&](std::size_t r) {
    return weights.segment(static_cast<Index>(data.starts[r]),
                           static_cast<Index>(data.records[r].size()));
  };
  std::map<std::string, double> half;
  for (std::size_t r = 0; r < data.records.size(); ++r)
    half[data.records[r].name] += 0.5 * weights_of(r).sum();
  std::map<std::string, double> sum;
  VectorXd result = VectorXd::Zero(weights.size());
  for (std::size_t r = 0; r < data.records.size(); ++r) {
    const std::string& name = data.records[r].name;
    const VectorXd own = weights_of(r);
    for (Index k = 0; k < own.size(); ++k) {
      sum[name] += own[k];
      if ((sum[name] <= half[name]) == first)
        result[static_cast<Index>(data.starts[r]) + k] = own[k];
    }
  }
  return result;
}

/// True for a number of a change in time and for the parameter that changes: a half of the record
/// knows its value on one side of the change alone.
bool changes(const FitSummary& fitted, const std::string& name) {
  const std::string own = "change." + name + ".";
  return name.starts_with("change.") ||
         std::any_of(fitted.parameters.begin(), fitted.parameters.end(),
                     [&](const FreeParameter& p) { return p.name.starts_with(own); });
}

}  // namespace

VectorXd split_scatter(const SearchContext& context, const FitSummary& fitted,
                       const VectorXd& weights, double observer_per_s) {
  const DiagnosisProblem& problem = context.problem;
  FitOptions options;
  options.max_iterations = kHalfIterations;
  options.observer_per_s = observer_per_s;
  options.cancel = context.options.cancel;
  std::array<FitSummary, 2> halves;
  std::array<VectorXd, 2> errors;
  in_parallel(halves.size(), context.options.threads, [&](std::size_t i) {
    const VectorXd half = half_of(problem.data, weights, i == 0);
    halves[i] = fit(problem.model, problem.data, half, fitted.parameters, fitted.theta, options);
    errors[i] = std_errors(problem.data, half, halves[i]);
  });
  VectorXd scatter = VectorXd::Zero(fitted.theta.size());
  if (context.cancelled()) return scatter;
  for (Index i = 0; i < scatter.size(); ++i) {
    if (changes(fitted, fitted.parameters[static_cast<std::size_t>(i)].name)) continue;
    const double apart = std::abs(halves[0].theta[i] - halves[1].theta[i]);
    double expected = 0.0;  // a half that ends at a bound has no error
    for (const VectorXd& error : errors) {
      if (std::isfinite(error[i])) expected = std::hypot(expected, error[i]);
    }
    if (expected > 0.0 && apart > kClearlyApart * expected) scatter[i] = 0.5 * apart;
  }
  return scatter;
}

}  // namespace estimator::greybox::selection
