#include "estimator/greybox/selection/other_fits.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "estimator/greybox/selection/alternative_refinements.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {

namespace {

/// Lead in -2 log L that a fit from another start does not make up for after a quick look.
constexpr double kFarBehind = 100.0;
/// Deviation of a lag in -2 log L from what a fit's slopes expect, absolute and as a share, up to
/// which a quick look is on its way to the same optimum, and the squared standard errors up to
/// which slopes hold.
constexpr double kSameOptimum = 1.0;
constexpr double kSameShape = 0.2;
constexpr double kSlopesHold = 25.0;
/// Fall of -2 log L for each parameter that one refinement has more than that whose place it takes.
/// A shorter one may be as much less likely.
constexpr double kPerRefinement = 6.0;

double count(const FitSummary& fitted) { return static_cast<double>(fitted.parameters.size()); }

bool have_the_same_parameters(const FitSummary& one, const FitSummary& other) {
  return std::equal(one.parameters.begin(), one.parameters.end(), other.parameters.begin(),
                    other.parameters.end(),
                    [](const auto& a, const auto& b) { return a.name == b.name; });
}

}  // namespace

bool is_on_the_way(const FitSummary& fitted, const FitSummary& other, double lag, double floor_m) {
  if (!(lag >= 0.0) || fitted.jacobian.cols() != fitted.theta.size() ||
      !have_the_same_parameters(fitted, other)) {
    return false;
  }
  const Eigen::VectorXd by = other.theta - fitted.theta;
  for (Eigen::Index i = 0; i < by.size(); ++i) {
    if (by[i] != 0.0 && fitted.jacobian.col(i).cwiseAbs().maxCoeff() == 0.0) return false;
  }
  double expected = (fitted.jacobian * by).squaredNorm() / (floor_m * floor_m);
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const double sd = fitted.parameters[i].prior_sd;
    if (std::isfinite(sd)) expected += std::pow(by[static_cast<Eigen::Index>(i)] / sd, 2);
  }
  return expected < kSlopesHold &&
         std::abs(expected - lag) < std::max(kSameOptimum, kSameShape * lag);
}

FitSummary likeliest_fit(const SearchContext& context, FitSummary fitted,
                         const std::vector<OtherStart>& others, InnovationFit effort,
                         SimulationWidth width) {
  const double floor_m = context.problem.data.noise_floor_m;
  const auto cost = [&](const FitSummary& fit) { return squares(fit, floor_m) + prior_cost(fit); };
  const bool side_by_side = others.size() > 1;
  const SimulationWidth own = side_by_side ? SimulationWidth{} : width;
  std::vector<std::optional<FitSummary>> found(others.size());
  in_parallel(others.size(), side_by_side ? width.threads : 1, [&](std::size_t i) {
    if (context.cancelled()) return;
    ParameterSubset start = others[i].start;
    FitSummary look = fit_innovations(context, start, own, InnovationFit::quick);
    const double lag = cost(look) - cost(fitted);
    if (lag > kFarBehind || is_on_the_way(fitted, look, lag, floor_m)) return;
    start.start = std::move(look.theta);
    found[i] = fit_innovations(context, start, own, effort);
  });
  for (std::size_t i = 0; i < others.size(); ++i) {
    if (!found[i] || ends_at_least(*found[i])) continue;
    const double least_fall =
        others[i].least_fall + kPerRefinement * (count(*found[i]) - count(fitted));
    if (cost(*found[i]) + least_fall < cost(fitted)) fitted = *std::move(found[i]);
  }
  return fitted;
}

}  // namespace estimator::greybox::selection
