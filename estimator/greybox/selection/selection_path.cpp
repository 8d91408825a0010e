#include "estimator/greybox/selection/selection_path.h"

#include <algorithm>
#include <utility>

#include "estimator/greybox/selection/candidate_gain.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

/// Iterations after which only fits within that factor of the best continue.
constexpr int kPathIterations = 8;
constexpr double kFarStage = 1.5;
/// An effect that removes this share of the held-out error needs no cross-validation.
constexpr double kPlainToSee = 0.5;
/// Share of the error that an effect has to remove to help: fits converge to a tenth of it.
constexpr double kHelps = 1e-4;

ParameterSubset all(const ModelStage& stage) {
  return subset(stage.fitted, [](const auto&) { return true; });
}

/// The effect's parameters, which start at their values in the final model.
ParameterSubset own(const ModelStage& final, const std::string& effect) {
  return subset(final.fitted, [&](const auto& p) { return belongs_to(p, effect); });
}

/// `before` with one further effect.
ParameterSubset taking(const ModelStage& before, const ModelStage& final,
                       const std::string& effect) {
  ParameterSubset selection = all(before);
  append(selection, own(final, effect));
  return selection;
}

ModelStage taken(const ModelStage& before, const std::string& effect, FitSummary fitted) {
  ModelStage next{before.added, std::move(fitted)};
  next.added.push_back(effect);
  return next;
}

/// The most effective single addition.
ModelStage best_of(const SearchContext& context, const ModelStage& before, const ModelStage& final,
                   const std::vector<std::string>& effects) {
  FitOptions begin;
  begin.max_iterations = kPathIterations;
  begin.final_jacobian = false;
  begin.cancel = context.options.cancel;
  std::vector<ParameterSubset> subsets;
  subsets.reserve(effects.size());
  for (const std::string& effect : effects) subsets.push_back(taking(before, final, effect));
  std::vector<FitSummary> fits(effects.size());
  in_parallel(effects.size(), context.options.threads, [&](std::size_t i) {
    fits[i] = fit(context.problem.model, context.problem.data, context.problem.data.training_mask,
                  subsets[i].parameters, subsets[i].start, begin);
  });
  const auto lower = [](const auto& a, const auto& b) {
    return a.validation_rms_m < b.validation_rms_m;
  };
  const double least_m = std::min_element(fits.begin(), fits.end(), lower)->validation_rms_m;
  const auto far = [&](const auto& fit) { return fit.validation_rms_m > kFarStage * least_m; };
  const auto near =
      static_cast<std::ptrdiff_t>(fits.size()) - std::count_if(fits.begin(), fits.end(), far);
  const SimulationWidth width = near == 1 ? wide(context.options.threads) : SimulationWidth{};
  in_parallel(effects.size(), context.options.threads, [&](std::size_t i) {
    if (far(fits[i])) return;
    fits[i] = refit(context, {subsets[i].parameters, fits[i].theta},
                    context.problem.data.training_mask, width);
  });
  const auto best = std::min_element(fits.begin(), fits.end(), lower);
  return taken(before, effects[static_cast<std::size_t>(best - fits.begin())], std::move(*best));
}

/// A step that takes several effects at once, without those that it does not need: each of these
/// comes in after it.
std::vector<ModelStage> divided(const SearchContext& context, const ModelStage& before,
                                ModelStage joint) {
  const auto first = static_cast<std::ptrdiff_t>(before.added.size());
  const std::vector<std::string> taken_at_once(joint.added.begin() + first, joint.added.end());
  if (taken_at_once.size() < 3) return {std::move(joint)};
  const double joint_m = joint.fitted.validation_rms_m;
  double least_m = (1.0 + worthwhile_at(context, joint_m)) * joint_m;
  std::string dispensable;
  ModelStage rest;
  for (const std::string& effect : taken_at_once) {
    if (context.cancelled()) break;
    FitSummary without =
        refit(context, subset(joint.fitted, [&](const auto& p) { return !belongs_to(p, effect); }),
              context.problem.data.training_mask, wide(context.options.threads));
    if (without.validation_rms_m >= least_m) continue;
    least_m = without.validation_rms_m;
    dispensable = effect;
    rest = ModelStage{joint.added, std::move(without)};
  }
  if (dispensable.empty()) return {std::move(joint)};
  std::erase(rest.added, dispensable);
  std::erase(joint.added, dispensable);
  joint.added.push_back(dispensable);
  std::vector<ModelStage> steps = divided(context, before, std::move(rest));
  steps.push_back(std::move(joint));
  return steps;
}

}  // namespace

std::vector<ModelStage> path_to(const SearchContext& context, const ModelStage& first,
                                const ModelStage& final) {
  std::vector<ModelStage> path{first};
  ModelStage before = first;
  std::vector<std::string> remaining = final.added;
  const auto take = [&](ModelStage stage) {
    for (ModelStage& step : divided(context, path.back(), std::move(stage)))
      path.push_back(std::move(step));
  };
  while (remaining.size() > 1 && !context.cancelled()) {
    before = best_of(context, before, final, remaining);
    std::erase(remaining, before.added.back());
    const double enough_m = (1.0 - kHelps) * path.back().fitted.validation_rms_m;
    if (before.fitted.validation_rms_m < enough_m) take(before);
  }
  if (remaining.empty()) return path;
  ModelStage last = final;
  last.added = std::move(before.added);
  last.added.insert(last.added.end(), remaining.begin(), remaining.end());
  take(std::move(last));
  return path;
}

std::vector<ModelStage> cross_validated_path(const SearchContext& context, CrossValidation& halves,
                                             const std::vector<ModelStage>& path) {
  std::vector<ModelStage> kept{path.front()};
  for (std::size_t i = 1; i < path.size() && !context.cancelled(); ++i) {
    ModelStage more = kept.back();
    ParameterSubset selection = all(more);
    const std::vector<std::string>& added = path[i].added;
    for (std::size_t k = path[i - 1].added.size(); k < added.size(); ++k) {
      append(selection, own(path.back(), added[k]));
      more.added.push_back(added[k]);
    }
    more.fitted = refit(context, selection, context.problem.data.training_mask,
                        wide(context.options.threads));
    // a fit from the stage before may end elsewhere than the path's own
    if (kept.size() == i && path[i].fitted.training_rms_m < more.fitted.training_rms_m) {
      more = path[i];
    }
    const bool plain_to_see =
        more.fitted.validation_rms_m < kPlainToSee * kept.back().fitted.validation_rms_m;
    if (plain_to_see || halves.holds(false, all(kept.back()), all(more))) {
      kept.push_back(std::move(more));
    }
  }
  return kept;
}

}  // namespace estimator::greybox::selection
