#include "estimator/greybox/selection/parameter_subset.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "estimator/greybox/selection/revived_refinements.h"
#include "plant_sim/library.h"

namespace estimator::greybox::selection {
namespace {

/// Iterations between two checks.
constexpr int kStride = 8;
/// Error ratio to the best at the first check above which a fit is stopped.
constexpr double kHopeless = 3.0;
constexpr double kHopelessAtFirst = 10.0;
/// Error ratio that counts as near.
constexpr double kNear = 1.1;
/// Limit of the remaining decrease, in decreases like that of the last check.
constexpr double kPatience = 4.0;
constexpr int kMostStrides = 8;
/// Damping ratio of a resonance below which there is none: metal alone has some 0.001.
constexpr double kLeastDamping = 2e-4;
/// Share of the error by which a refinement brought back has to lower it.
constexpr double kRevivedShare = 1e-3;

}  // namespace

bool ends_at_bound(const FitSummary& fitted, std::size_t count) {
  const auto end = static_cast<std::ptrdiff_t>(std::min(count, fitted.at_bound.size()));
  return std::any_of(fitted.at_bound.begin(), fitted.at_bound.begin() + end,
                     [](int bound) { return bound != 0; });
}

bool leaves_its_range(const FitSummary& fitted, std::size_t first) {
  return leaves_its_range(fitted, first, fitted.parameters.size());
}

bool leaves_its_range(const FitSummary& fitted, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    const FreeParameter& p = fitted.parameters[i];
    const bool is_angle = p.name.find(".phase_rad") != std::string::npos;
    const double theta = fitted.theta[static_cast<Eigen::Index>(i)];
    if (p.name.ends_with(".damping_ratio") && p.to_physical(theta) < kLeastDamping) return true;
    const bool absent = theta == 0.0;
    if (p.refinement == 0 && fitted.at_bound[i] != 0 && !absent && !is_angle) return true;
  }
  return false;
}

void wrap_phases(FitSummary& fitted) {
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const FreeParameter& p = fitted.parameters[i];
    const bool has_prior = p.prior_sd > 0.0 && std::isfinite(p.prior_sd);
    if (!p.name.ends_with(".phase_rad") || has_prior) continue;
    if (plant_sim::find_effect(effect_of(p)) == nullptr) continue;
    double& theta = fitted.theta[static_cast<Eigen::Index>(i)];
    const double phase_rad = p.to_physical(theta);
    const double wrapped = p.to_theta(std::remainder(phase_rad, 2.0 * std::numbers::pi));
    if (wrapped == theta || !(wrapped > p.lower && wrapped < p.upper)) continue;
    theta = wrapped;
    fitted.at_bound[i] = 0;
  }
}

void append(ParameterSubset& to, const ParameterSubset& more) {
  Eigen::VectorXd start(to.start.size() + more.start.size());
  start << to.start, more.start;
  to.start = std::move(start);
  to.parameters.insert(to.parameters.end(), more.parameters.begin(), more.parameters.end());
}

void take_values(const FitSummary& known, FitSummary& fitted, double share_of_others) {
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const FreeParameter& p = fitted.parameters[i];
    double& theta = fitted.theta[static_cast<Eigen::Index>(i)];
    const double value = known.value(p.name);
    theta = std::clamp(std::isfinite(value) ? p.to_theta(value) : share_of_others * theta, p.lower,
                       p.upper);
  }
}

FitSummary refit(const SearchContext& context, const ParameterSubset& selection,
                 const Eigen::VectorXd& weights, SimulationWidth width, double observer_per_s) {
  FitOptions options;
  options.width = width;
  options.tolerance = 1e-5;
  options.observer_per_s = observer_per_s;
  options.cancel = context.options.cancel;
  return fit(context.problem.model, context.problem.data, weights, selection.parameters,
             selection.start, options);
}

FitSummary refit_if_hopeful(const SearchContext& context, const ParameterSubset& selection,
                            double than_m, SimulationWidth width) {
  FitOptions stride;
  stride.width = width;
  stride.max_iterations = kStride;
  stride.passes = 1;
  stride.final_jacobian = false;
  stride.cancel = context.options.cancel;
  FitSummary at;
  at.theta = selection.start;
  double before_m = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kMostStrides; ++k) {
    at = fit(context.problem.model, context.problem.data, context.problem.data.training_mask,
             selection.parameters, at.theta, stride);
    const double left_m = at.validation_rms_m - kNear * than_m;
    if (left_m <= 0.0) break;
    const double hopeless = k == 0 ? kHopelessAtFirst : kHopeless;
    if (at.validation_rms_m > hopeless * than_m ||
        left_m > kPatience * (before_m - at.validation_rms_m)) {
      return at;
    }
    before_m = at.validation_rms_m;
    stride.start_residual_m = at.residual_m;
    stride.start_jacobian = at.jacobian;
  }
  return refit(context, {selection.parameters, at.theta}, context.problem.data.training_mask,
               width);
}

FitSummary refit_to_convergence(const SearchContext& context, const FitSummary& fitted) {
  return refit(context, subset(fitted, [](const auto&) { return true; }),
               context.problem.data.training_mask, wide(context.options.threads));
}

void revive(const SearchContext& context, FitSummary& fitted) {
  for (const Eigen::VectorXd& start : revived_refinements(context.problem.model, fitted)) {
    if (context.cancelled()) return;
    FitSummary other = refit(context, {fitted.parameters, start},
                             context.problem.data.training_mask, wide(context.options.threads));
    if (other.training_rms_m < (1.0 - kRevivedShare) * fitted.training_rms_m)
      fitted = std::move(other);
  }
}

bool is_idle(const FitSummary& fitted, const std::string& effect) {
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    if (belongs_to(fitted.parameters[i], effect) && fitted.parameters[i].refinement == 0) {
      return fitted.parameters[i].scale == ParameterScale::linear &&
             fitted.theta[static_cast<Eigen::Index>(i)] == 0.0;
    }
  }
  return false;
}

void drop_idle_refinements(const std::vector<std::string>& added, FitSummary& fitted) {
  using Eigen::Index;
  const auto count = static_cast<Index>(fitted.parameters.size());
  if (fitted.jacobian.cols() != count) return;
  const auto is_idle_parameter = [&](Index i) {
    const FreeParameter& p = fitted.parameters[static_cast<std::size_t>(i)];
    const bool least = p.instead_of > 0 && fitted.theta[i] <= p.lower;
    return fitted.theta[i] == 0.0 || least || fitted.jacobian.col(i).cwiseAbs().maxCoeff() == 0.0;
  };
  std::vector<Index> kept;
  for (Index i = 0; i < count; ++i) {
    const FreeParameter& p = fitted.parameters[static_cast<std::size_t>(i)];
    bool idle = p.refinement > 0 && !p.in_model &&
                std::find(added.begin(), added.end(), effect_of(p)) != added.end();
    for (Index k = 0; idle && k < count; ++k) {
      const FreeParameter& other = fitted.parameters[static_cast<std::size_t>(k)];
      const bool together = other.refinement == p.refinement && effect_of(other) == effect_of(p);
      idle = !together || is_idle_parameter(k);
    }
    if (!idle) kept.push_back(i);
  }
  if (static_cast<Index>(kept.size()) == count) return;
  FitSummary rest = fitted;
  rest.parameters.clear();
  rest.at_bound.clear();
  for (const Index i : kept) {
    rest.parameters.push_back(fitted.parameters[static_cast<std::size_t>(i)]);
    rest.at_bound.push_back(fitted.at_bound[static_cast<std::size_t>(i)]);
  }
  rest.theta = fitted.theta(kept);
  rest.jacobian = Eigen::MatrixXd(fitted.jacobian(Eigen::all, kept));
  fitted = std::move(rest);
}

void drop_empty_effects(std::vector<std::string>& added, const FitSummary& fitted) {
  std::erase_if(added, [&](const std::string& effect) {
    return std::none_of(fitted.parameters.begin(), fitted.parameters.end(),
                        [&](const FreeParameter& p) { return belongs_to(p, effect); });
  });
}

}  // namespace estimator::greybox::selection
