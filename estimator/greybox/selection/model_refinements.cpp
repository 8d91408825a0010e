#include "estimator/greybox/selection/model_refinements.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "estimator/greybox/dataset_simulation.h"
#include "estimator/greybox/selection/further_refinements.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/search_round.h"
#include "estimator/greybox/selection/trial_sizes.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Error over the noise from which on a fit may have ended beside the truth.
constexpr double kMayBeBeside = 1.5;

bool refines_model(const SearchContext& context, const std::string& effect) {
  const plant_sim::EffectInfo* known = plant_sim::find_effect(effect);
  return known != nullptr && has_effect(context.problem.model, *known);
}

/// The stage's parameters at `base`, then a refinement's, `own`, at the trial sizes that leave
/// least; no start where all leave the same, without influence.
ParameterSubset best_beside(const SearchContext& context, const ModelStage& stage,
                            const VectorXd& base, const std::vector<FreeParameter>& own) {
  ParameterSubset best{stage.fitted.parameters, {}};
  best.parameters.insert(best.parameters.end(), own.begin(), own.end());
  const MatrixXd sizes = trial_sizes(own, context.problem.data, context.problem.trial_sizes);
  DatasetSimulation run(context.problem.model, context.problem.data, best.parameters);
  double least_m = std::numeric_limits<double>::infinity();
  double most_m = 0.0;
  for (Index from = 0; from < sizes.cols(); from += ObserverSimulation::kLanes) {
    const Index lanes = std::min<Index>(ObserverSimulation::kLanes, sizes.cols() - from);
    MatrixXd points(base.size() + sizes.rows(), lanes);
    points << base.replicate(1, lanes), sizes.middleCols(from, lanes);
    MatrixXd residuals_m;
    run.residuals(points, residuals_m);
    for (Index lane = 0; lane < lanes; ++lane) {
      const double left_m = rms(residuals_m.col(lane), context.problem.data.training_mask);
      most_m = std::max(most_m, left_m);
      if (!(left_m < least_m)) continue;
      least_m = left_m;
      best.start = points.col(lane);
    }
  }
  if (!(most_m > least_m)) best.start.resize(0);
  return best;
}

/// The refinements that a search begins with, together, and each of the others.
std::vector<std::vector<FreeParameter>> parts_of(const plant_sim::EffectInfo& refinements) {
  std::vector<std::vector<FreeParameter>> parts = further_refinements(refinements, {});
  parts.insert(parts.begin(), effect_parameters(refinements, kFirstRefinements));
  return parts;
}

FitSummary best_fit(const SearchContext& context, const ModelStage& stage,
                    const Candidate& candidate) {
  FitSummary best = refit_to_convergence(context, candidate.fitted);
  revive(context, best);
  for (const plant_sim::EffectInfo& effect : context.problem.candidate_effects) {
    if (effect.name != candidate.effects.front()) continue;
    for (const std::vector<FreeParameter>& own : parts_of(effect)) {
      for (const VectorXd& base : {with_file_values(context, stage), stage.fitted.theta}) {
        if (own.empty() || context.cancelled()) continue;
        const ParameterSubset start = best_beside(context, stage, base, own);
        if (start.start.size() == 0) continue;
        FitSummary other = refit(context, start, context.problem.data.training_mask,
                                 wide(context.options.threads));
        revive(context, other);
        if (other.training_rms_m < best.training_rms_m) best = std::move(other);
      }
    }
  }
  return best;
}

}  // namespace

void refit_model_refinements(const SearchContext& context, const ModelStage& stage,
                             std::vector<Candidate>& candidates) {
  if (!(stage.fitted.validation_rms_m > kMayBeBeside * context.problem.data.noise_floor_m)) return;
  for (Candidate& candidate : candidates) {
    if (context.cancelled()) return;
    if (!candidate.fitted_at_all || !refines_model(context, candidate.effects.front())) continue;
    FitSummary fitted = best_fit(context, stage, candidate);
    if (context.cancelled() || !(fitted.training_rms_m < candidate.fitted.training_rms_m)) continue;
    candidate.fitted = std::move(fitted);
    candidate.validation_rms_m = candidate.fitted.validation_rms_m;
    candidate.p_value = chance(context, stage.fitted, candidate.fitted);
  }
}

}  // namespace estimator::greybox::selection
