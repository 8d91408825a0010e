#include "estimator/greybox/selection/split_scatter.h"

#include <array>
#include <cmath>

#include "estimator/greybox/fit.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kHalfIterations = 10;
/// Distance over its error that chance reaches once in twenty.
constexpr double kClearlyApart = 2.0;

/// The weights of the first or the last samples that count, half of all.
VectorXd half_of(const VectorXd& weights, bool first) {
  const double half = 0.5 * weights.sum();
  VectorXd result = VectorXd::Zero(weights.size());
  double sum = 0.0;
  for (Index k = 0; k < weights.size(); ++k) {
    sum += weights[k];
    if ((sum <= half) == first) result[k] = weights[k];
  }
  return result;
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
    const VectorXd half = half_of(weights, i == 0);
    halves[i] = fit(problem.model, problem.data, half, fitted.parameters, fitted.theta, options);
    errors[i] = std_errors(problem.data, half, halves[i]);
  });
  VectorXd scatter = VectorXd::Zero(fitted.theta.size());
  if (context.cancelled()) return scatter;
  for (Index i = 0; i < scatter.size(); ++i) {
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
