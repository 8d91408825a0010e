#include "estimator/greybox/selection/further_refinements.h"

#include <algorithm>
#include <map>

#include "estimator/greybox/selection/innovation_trials.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {
std::vector<std::vector<FreeParameter>> further_refinements(const plant_sim::EffectInfo& effect,
                                                            const FitSummary& fitted) {
  std::map<int, std::vector<FreeParameter>> missing;
  for (const FreeParameter& p : effect_parameters(effect, kEveryRefinement)) {
    const bool there =
        std::any_of(fitted.parameters.begin(), fitted.parameters.end(),
                    [&](const FreeParameter& other) { return other.name == p.name; });
    if (!there && p.refinement > kFirstRefinements && p.instead_of == 0)
      missing[p.refinement].push_back(p);
  }
  std::vector<std::vector<FreeParameter>> refinements;
  for (auto& [number, parameters] : missing) refinements.push_back(std::move(parameters));
  return refinements;
}

std::vector<std::vector<FreeParameter>> further_refinements(const SearchContext& context,
                                                            const FitSummary& fitted,
                                                            const std::string& effect) {
  for (const plant_sim::EffectInfo& candidate : context.problem.candidate_effects) {
    if (candidate.name == effect) return further_refinements(candidate, fitted);
  }
  return {};
}

ParameterSubset refined(const FitSummary& fitted, const std::vector<FreeParameter>& refinement) {
  ParameterSubset all = subset(fitted, [](const auto&) { return true; });
  Eigen::VectorXd start(static_cast<Eigen::Index>(refinement.size()));
  for (std::size_t i = 0; i < refinement.size(); ++i) {
    start[static_cast<Eigen::Index>(i)] =
        refinement[i].scale == ParameterScale::reciprocal ? 1.0 : 0.0;
  }
  append(all, {refinement, start});
  return all;
}

void take_further_refinements(const SearchContext& plain, double evidence_nats,
                              InnovationStage& stage) {
  const SimulationWidth width = wide(plain.options.threads);
  for (const std::string& effect : std::vector<std::string>(stage.model.added)) {
    for (const auto& more : further_refinements(plain, stage.model.fitted, effect)) {
      if (plain.cancelled()) return;
      ModelStage with_more{stage.model.added,
                           fit_innovations(stage.context, refined(stage.model.fitted, more), width,
                                           InnovationFit::trial)};
      const double floor_m = plain.problem.data.noise_floor_m;
      const double gain_nats =
          0.5 * (squares(stage.model.fitted, floor_m) - squares(with_more.fitted, floor_m)) -
          penalty_nats(with_more.fitted, stage.model.fitted);
      if (!(gain_nats > evidence_nats)) continue;
      InnovationStage reached =
          settled(plain, std::move(with_more), stage.noise, Settling::fully, width);
      if (penalised(reached) < penalised(stage) - 2.0 * evidence_nats) stage = std::move(reached);
    }
  }
}

}  // namespace estimator::greybox::selection
