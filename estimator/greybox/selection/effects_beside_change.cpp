#include "estimator/greybox/selection/effects_beside_change.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "estimator/greybox/selection/parameter_subset.h"

namespace estimator::greybox::selection {
namespace {

constexpr std::size_t kMostBeside = 2;
/// Least gain of the change, in those of the largest curve that it leaves.
constexpr double kBelieved = 2.0;
/// Share of the held-out error that it leaves at most: a search beside it takes as long as the
/// first.
constexpr double kMostLeft = 0.5;
/// Share of that curve that effects may leave: the change may have stood for one of another
/// parameter.
constexpr double kLeft = 0.5;

/// Share of its value by which an effect changes at least, to be more than an effect.
constexpr double kSteady_ratio = 0.2;

bool known(const ModelStage& first, const FreeParameter& parameter) {
  return std::any_of(first.fitted.parameters.begin(), first.fitted.parameters.end(),
                     [&](const FreeParameter& own) { return own.name == parameter.name; });
}

/// The fitted parameters of the model as given and of effects, those of changes left out.
ModelStage with_effects_alone(const ModelStage& first, const FitSummary& fitted,
                              const std::vector<std::string>& effects) {
  ModelStage stage;
  stage.added = effects;
  const ParameterSubset own = subset(fitted, [&](const FreeParameter& p) {
    return known(first, p) || std::any_of(effects.begin(), effects.end(),
                                          [&](const auto& name) { return belongs_to(p, name); });
  });
  stage.fitted.parameters = own.parameters;
  stage.fitted.theta = own.start;
  return stage;
}

}  // namespace

std::optional<ModelStage> effects_beside(const ModelStage& first, const ChangeSearch& change) {
  const InnovationSearch& alone = change.innovations;
  const double gained_nats = 0.5 * (penalised(alone.before) - penalised(alone.final));
  if (!alone.physics_missing() || alone.load_sets_in() ||
      !(gained_nats > kBelieved * alone.curve_nats)) {
    return {};
  }
  const double left_m = simulated(change.context, alone.final.model.fitted).validation_rms_m;
  if (!(left_m < kMostLeft * first.fitted.validation_rms_m)) return {};
  // the change is the plant's as long as effects are sought
  SearchContext context = change.context;
  std::erase_if(context.problem.candidate_effects, [&](const plant_sim::EffectInfo& effect) {
    return std::any_of(effect.parameters.begin(), effect.parameters.end(), [&](const auto& p) {
      return changes_parameter(change.changes, effect.name + "." + p.name);
    });
  });
  ModelStage base = alone.final.model;
  base.added.clear();
  SearchLimits limits;
  limits.most_effects = kMostBeside;
  const InnovationSearch found = search_innovations(context, base, {}, limits);
  const ModelStage& with = found.final.model;
  if (context.cancelled() || with.added.empty() || !(found.curve_nats < kLeft * alone.curve_nats)) {
    return {};
  }
  return with_effects_alone(first, with.fitted, with.added);
}

std::optional<ModelStage> steady_effect(const ModelStage& first, const ChangeSearch& change) {
  for (const ParameterChange& one : change.changes) {
    const double size = std::max(std::abs(one.from), std::abs(one.to));
    if (std::abs(one.to - one.from) > kSteady_ratio * size) continue;
    const FitSummary& fitted = change.innovations.final.model.fitted;
    const auto own = std::find_if(fitted.parameters.begin(), fitted.parameters.end(),
                                  [&](const FreeParameter& p) { return p.name == one.parameter; });
    if (own == fitted.parameters.end() || known(first, *own)) continue;
    std::vector<std::string> effects = change.innovations.final.model.added;
    std::erase_if(effects, [](const std::string& name) { return name.starts_with("change."); });
    if (std::find(effects.begin(), effects.end(), effect_of(*own)) != effects.end()) continue;
    effects.push_back(effect_of(*own));
    return with_effects_alone(first, fitted, effects);
  }
  return {};
}

}  // namespace estimator::greybox::selection
