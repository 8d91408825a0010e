#include "estimator/greybox/selection/effects_beside_change.h"

#include <algorithm>
#include <string>

#include "estimator/greybox/selection/parameter_subset.h"

namespace estimator::greybox::selection {
namespace {

constexpr std::size_t kMostBeside = 2;
/// Least gain of the change, in those of the largest curve that it leaves.
constexpr double kBelieved = 2.0;
/// Share of that curve that effects may leave: the change may have stood for one of another
/// parameter.
constexpr double kLeft = 0.5;

bool known(const ModelStage& first, const FreeParameter& parameter) {
  return std::any_of(first.fitted.parameters.begin(), first.fitted.parameters.end(),
                     [&](const FreeParameter& own) { return own.name == parameter.name; });
}

/// Parameters of an effect that the model as given does not have and that changes.
bool belongs_to_change(const ChangeSearch& change, const std::string& effect) {
  return std::any_of(change.changes.begin(), change.changes.end(), [&](const ParameterChange& one) {
    return one.parameter.starts_with(effect + ".");
  });
}

}  // namespace

std::optional<ModelStage> effects_beside(const ModelStage& first, const ChangeSearch& change) {
  const InnovationSearch& alone = change.innovations;
  const double gained_nats = 0.5 * (penalised(alone.before) - penalised(alone.final));
  if (!alone.physics_missing() || alone.load_sets_in() ||
      !(gained_nats > kBelieved * alone.curve_nats)) {
    return {};
  }
  // the change is the plant's as long as effects are sought
  SearchContext context = change.context;
  std::erase_if(context.problem.candidate_effects, [&](const plant_sim::EffectInfo& effect) {
    return belongs_to_change(change, effect.name);
  });
  ModelStage base = alone.final.model;
  base.added.clear();
  SearchLimits limits;
  limits.most_effects = kMostBeside;
  const InnovationSearch found = search_innovations(context, base, {}, limits);
  const ModelStage& with = found.final.model;
  if (context.cancelled() || with.added.empty() ||
      !(found.curve_nats < kLeft * alone.curve_nats)) {
    return {};
  }
  ModelStage effects;
  effects.added = with.added;
  const ParameterSubset own = subset(with.fitted, [&](const FreeParameter& p) {
    return known(first, p) || std::any_of(with.added.begin(), with.added.end(),
                                          [&](const auto& name) { return belongs_to(p, name); });
  });
  effects.fitted.parameters = own.parameters;
  effects.fitted.theta = own.start;
  return effects;
}

}  // namespace estimator::greybox::selection
