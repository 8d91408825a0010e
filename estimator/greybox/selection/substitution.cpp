#include "estimator/greybox/selection/substitution.h"

#include <algorithm>
#include <cmath>

#include "estimator/greybox/fit.h"
#include "estimator/greybox/selection/candidate_gain.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/search_round.h"

namespace estimator::greybox::selection {
namespace {

ModelStage without(const SearchContext& context, const ModelStage& stage,
                   const std::string& effect) {
  ModelStage rest = stage;
  std::erase(rest.added, effect);
  const ParameterSubset others =
      subset(stage.fitted, [&](const auto& p) { return !belongs_to(p, effect); });
  rest.fitted =
      refit(context, others, context.problem.data.training_mask, wide(context.options.threads));
  return rest;
}

/// True when the effect's size, its first parameter, is zero or within its error.
bool is_small(const SearchContext& context, const FitSummary& fitted, const std::string& effect) {
  if (is_idle(fitted, effect)) return true;
  if (fitted.jacobian.cols() != fitted.theta.size()) return false;
  const Eigen::VectorXd errors =
      std_errors(context.problem.data, context.problem.data.training_mask, fitted);
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (belongs_to(fitted.parameters[i], effect) && fitted.parameters[i].refinement == 0)
      return std::abs(fitted.theta[k]) < errors[k];
  }
  return false;
}

std::ptrdiff_t own_count(const FitSummary& fitted, const std::string& effect) {
  return std::count_if(fitted.parameters.begin(), fitted.parameters.end(),
                       [&](const FreeParameter& p) { return belongs_to(p, effect); });
}

/// True when another effect with fewer parameters came as near in the round in which this one was
/// taken: refinements of the others, given up since, may have held it back.
bool has_simpler_rival(const SearchBranch& branch, const std::string& effect) {
  const Round* taken_in = nullptr;
  for (const Round& round : branch.rounds) {
    const auto& before = round.before.added;
    if (std::find(before.begin(), before.end(), effect) == before.end()) taken_in = &round;
  }
  if (taken_in == nullptr) return false;
  const FitSummary& found = branch.stage.fitted;
  const auto& added = branch.stage.added;
  return std::any_of(taken_in->candidates.begin(), taken_in->candidates.end(),
                     [&](const Candidate& other) {
                       const std::string& name = other.effects.front();
                       return other.fitted_at_all && other.effects.size() == 1 &&
                              std::find(added.begin(), added.end(), name) == added.end() &&
                              other.validation_rms_m < (1.0 + kRivals) * found.validation_rms_m &&
                              own_count(other.fitted, name) < own_count(found, effect);
                     });
}

}  // namespace

void substitute_idle_effects(const SearchContext& context, SearchBranch& branch) {
  if (branch.stage.added.size() < 2) return;
  const std::vector<std::string> added = branch.stage.added;
  for (const std::string& effect : added) {
    const bool competes =
        is_small(context, branch.stage.fitted, effect) || has_simpler_rival(branch, effect);
    if (!competes || context.cancelled()) continue;
    Round round = single_round(context, without(context, branch.stage, effect),
                               static_cast<int>(branch.rounds.size()) + 1);
    if (round.candidates.empty()) continue;
    const Candidate& chosen = simplest(context, round.candidates);
    const bool as_good =
        chosen.validation_rms_m < (1.0 + worthwhile_at(context, chosen.validation_rms_m)) *
                                      branch.stage.fitted.validation_rms_m;
    if (chosen.effects.front() != effect && as_good) {
      branch.stage = with(round.before, chosen);
      if (branch.stage.fitted.jacobian.size() == 0) {
        branch.stage.fitted = refit_to_convergence(context, branch.stage.fitted);
      }
    }
    branch.rounds.push_back(std::move(round));
  }
}

}  // namespace estimator::greybox::selection
