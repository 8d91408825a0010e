#include "estimator/greybox/selection/completed_candidates.h"

#include <algorithm>

#include "estimator/greybox/selection/alternative_refinements.h"
#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/search_round.h"

namespace estimator::greybox::selection {
namespace {

/// Error over the estimated floor that a true model may leave.
constexpr double kAtFloor = 1.03;
/// Ratio to the taken effect's error up to which an early fit of another may end below it.
constexpr double kWithinReach = 1.6;
constexpr std::size_t kMostRivals = 3;

/// Makes a completed fit that of the candidate; its Jacobian is large and not needed there.
void replace(const SearchContext& context, const ModelStage& before, const FitSummary& fitted,
             Candidate& candidate) {
  candidate.fitted = fitted;
  candidate.fitted.jacobian.resize(0, 0);
  candidate.validation_rms_m = fitted.validation_rms_m;
  candidate.p_value = chance(context, before.fitted, fitted);
}

/// Takes another refinement of the effect where held-out data show that it leaves less.
void take_likelier_refinement(const SearchContext& context, ModelStage& stage) {
  ModelStage refined = stage;
  try_alternative_refinements(context, refined);
  const bool likelier = chance(context, stage.fitted, refined.fitted) < kChance;
  if (likelier && !context.cancelled()) stage = std::move(refined);
}

}  // namespace

ModelStage completed(const SearchContext& context, const ModelStage& stage,
                     const Candidate& candidate) {
  ModelStage taken = with(stage, candidate);
  if (taken.fitted.jacobian.size() == 0) taken.fitted = refit_to_convergence(context, taken.fitted);
  revive(context, taken.fitted);
  take_alternative_refinements(context, taken);
  return taken;
}

void complete_rivals(const SearchContext& context, SearchBranch& branch) {
  const std::vector<std::string> taken = branch.stage.added;
  const double floor_m = context.problem.data.noise_floor_m;
  if (taken.size() != 1 || branch.rounds.size() != 1 || !is_explained(context, branch.stage) ||
      branch.stage.fitted.validation_rms_m <= kAtFloor * floor_m) {
    return;
  }
  take_likelier_refinement(context, branch.stage);
  const double taken_m = branch.stage.fitted.validation_rms_m;
  if (taken_m <= kAtFloor * floor_m) return;
  Round& round = branch.rounds.front();
  std::size_t tried = 0;
  for (Candidate& candidate : round.candidates) {
    if (context.cancelled()) break;
    if (candidate.effects == taken) {
      if (taken_m < candidate.validation_rms_m)
        replace(context, round.before, branch.stage.fitted, candidate);
      continue;
    }
    if (candidate.effects.size() > 1 || !candidate.fitted_at_all || tried == kMostRivals ||
        candidate.validation_rms_m > kWithinReach * taken_m) {
      continue;
    }
    ++tried;
    ModelStage rival = completed(context, round.before, candidate);
    if (context.cancelled()) break;
    if (rival.fitted.validation_rms_m < candidate.validation_rms_m)
      replace(context, round.before, rival.fitted, candidate);
    const FitSummary& best = branch.stage.fitted;
    if (rival.fitted.validation_rms_m < best.validation_rms_m &&
        chance(context, best, rival.fitted) < kTold) {
      branch.stage = std::move(rival);
    }
  }
  sort_by_score(round.candidates);
}

}  // namespace estimator::greybox::selection
