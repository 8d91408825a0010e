#include "estimator/greybox/selection/joined_waves.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "estimator/greybox/selection/candidate_gain.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/structure_search.h"
#include "estimator/greybox/selection/trial_sizes.h"

namespace estimator::greybox::selection {
namespace {

const plant_sim::EffectInfo* candidate(const SearchContext& context, const std::string& effect) {
  const auto& all = context.problem.candidate_effects;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == effect; });
  return found == all.end() ? nullptr : &*found;
}

bool is_wave(const SearchContext& context, const std::string& effect) {
  const plant_sim::EffectInfo* info = candidate(context, effect);
  return info != nullptr && is_periodic(effect_parameters(*info, kFirstRefinements));
}

/// The stage with `kept` at the wavelength of `other`, without this one; none where that leaves
/// more.
std::optional<ModelStage> joined(const SearchContext& context, const ModelStage& stage,
                                 const std::string& kept, const std::string& other) {
  const SimulationWidth width = wide(context.options.threads);
  ModelStage rest{stage.added, {}};
  std::erase(rest.added, other);
  const ParameterSubset base = subset(stage.fitted, [&](const FreeParameter& p) {
    return !belongs_to(p, kept) && !belongs_to(p, other);
  });
  rest.fitted = refit(context, base, context.problem.data.training_mask, width);
  if (context.cancelled() || rest.fitted.jacobian.size() == 0) return {};
  const ParameterSubset start = start_of_wave(context, rest, *candidate(context, kept),
                                              stage.fitted.value(other + ".wavelength_m"));
  if (start.parameters.empty()) return {};
  const double most_m =
      (1.0 + worthwhile_at(context, stage.fitted.validation_rms_m)) * stage.fitted.validation_rms_m;
  rest.fitted = refit_if_hopeful(context, start, most_m, width);
  if (context.cancelled() || !(rest.fitted.validation_rms_m < most_m)) return {};
  return rest;
}

}  // namespace

void join_waves(const SearchContext& context, ModelStage& stage) {
  std::optional<ModelStage> best;
  for (const std::string& kept : stage.added) {
    for (const std::string& other : stage.added) {
      if (kept == other || !is_wave(context, kept) || !is_wave(context, other)) continue;
      std::optional<ModelStage> one = joined(context, stage, kept, other);
      if (one && (!best || one->fitted.validation_rms_m < best->fitted.validation_rms_m)) {
        best = std::move(one);
      }
    }
  }
  if (best) stage = *std::move(best);
}

}  // namespace estimator::greybox::selection
