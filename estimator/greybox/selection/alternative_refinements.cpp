#include "estimator/greybox/selection/alternative_refinements.h"

#include <algorithm>

#include "estimator/greybox/selection/candidate_gain.h"
#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/structure_search.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

/// Starts, in typical sizes, and the least that is another law than none.
constexpr double kStarts[] = {1.0, 0.2, 5.0};
constexpr double kLeast = 0.05;
/// Error over the noise beyond which much else is missing: the course of a refinement is not seen.
constexpr double kFarFromFloor_ratio = 100.0;

bool is_in(const FitSummary& fitted, const FreeParameter& parameter) {
  return std::any_of(fitted.parameters.begin(), fitted.parameters.end(),
                     [&](const FreeParameter& other) { return other.name == parameter.name; });
}

bool is_at_least(const FitSummary& fitted, std::size_t i) {
  const FreeParameter& p = fitted.parameters[i];
  return p.instead_of > 0 && fitted.theta[static_cast<Eigen::Index>(i)] <= p.lower;
}

}  // namespace

bool ends_at_least(const FitSummary& fitted) {
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    if (is_at_least(fitted, i)) return true;
  }
  return false;
}

ParameterSubset without_least(const FitSummary& fitted, const std::vector<std::string>& added) {
  ParameterSubset rest;
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const FreeParameter& p = fitted.parameters[i];
    const bool is_added = std::any_of(added.begin(), added.end(), [&](const std::string& effect) {
      return belongs_to(p, effect);
    });
    if (is_added && is_at_least(fitted, i)) continue;
    append(rest, {{p}, Eigen::VectorXd::Constant(1, fitted.theta[static_cast<Eigen::Index>(i)])});
  }
  return rest;
}

std::vector<ParameterSubset> alternative_refinements(const SearchContext& context,
                                                     const ModelStage& stage) {
  std::vector<ParameterSubset> found;
  for (const plant_sim::EffectInfo& effect : context.problem.candidate_effects) {
    const auto& added = stage.added;
    if (std::find(added.begin(), added.end(), effect.name) == added.end()) continue;
    for (FreeParameter other : effect_parameters(effect, kEveryRefinement)) {
      if (other.instead_of == 0 || is_in(stage.fitted, other)) continue;
      other.lower = std::max(other.lower, kLeast);
      const ParameterSubset plain = subset(stage.fitted, [&](const FreeParameter& p) {
        return !belongs_to(p, effect.name) || p.refinement == 0;
      });
      const ParameterSubset rest = subset(stage.fitted, [&](const FreeParameter& p) {
        return !belongs_to(p, effect.name) || p.refinement != other.instead_of;
      });
      const auto add_in_sizes = [&](const ParameterSubset& to) {
        for (const double size : kStarts) {
          const double start = std::clamp(size, other.lower, other.upper);
          found.push_back(to);
          append(found.back(), {{other}, Eigen::VectorXd::Constant(1, start)});
        }
      };
      add_in_sizes(plain);
      if (rest.parameters.size() < stage.fitted.parameters.size()) found.push_back(rest);
      if (rest.parameters.size() > plain.parameters.size()) add_in_sizes(rest);
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return a.parameters.size() < b.parameters.size();
  });
  return found;
}

void take_alternative_refinements(const SearchContext& context, ModelStage& stage) {
  if (!is_explained(context, stage)) try_alternative_refinements(context, stage);
}

void try_alternative_refinements(const SearchContext& context, ModelStage& stage) {
  const double left_m = stage.fitted.validation_rms_m;
  if (context.cancelled() || left_m > kFarFromFloor_ratio * context.problem.data.noise_floor_m) {
    return;
  }
  const std::vector<ParameterSubset> others = alternative_refinements(context, stage);
  std::vector<FitSummary> fits(others.size());
  in_parallel(others.size(), context.options.threads, [&](std::size_t i) {
    fits[i] = refit_if_hopeful(context, others[i], stage.fitted.validation_rms_m);
  });
  for (FitSummary& other : fits) {
    const double worthwhile = worthwhile_at(context, stage.fitted.validation_rms_m);
    if (context.cancelled() || ends_at_least(other) ||
        !(other.validation_rms_m < (1.0 - worthwhile) * stage.fitted.validation_rms_m)) {
      continue;
    }
    stage.fitted = std::move(other);
  }
  if (stage.fitted.jacobian.size() == 0) stage.fitted = refit_to_convergence(context, stage.fitted);
}

}  // namespace estimator::greybox::selection
