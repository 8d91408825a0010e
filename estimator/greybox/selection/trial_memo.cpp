#include "estimator/greybox/selection/trial_memo.h"

#include <cmath>
#include <utility>

namespace estimator::greybox::selection {

TrialMemo::StageKey TrialMemo::key_of(const InnovationStage& stage) {
  return {stage.minus_two_log, parameters_of(stage.model)};
}

std::vector<InnovationTrial> TrialMemo::effects_beside(const InnovationStage& stage) {
  if (!stage.model.added.empty()) return effect_trials(stage);
  StageKey key = key_of(stage);
  {
    const std::lock_guard lock(kept_->mutex);
    if (kept_->stage == key) return kept_->trials;
  }
  std::vector<InnovationTrial> trials = effect_trials(stage);
  if (stage.context.cancelled()) return trials;
  const std::lock_guard lock(kept_->mutex);
  kept_->stage = std::move(key);
  kept_->trials = trials;
  kept_->stages.clear();
  return trials;
}

InnovationStage TrialMemo::settled(const SearchContext& plain, const InnovationStage& stage,
                                   const InnovationTrial& trial) {
  const std::string& effect = trial.candidate.effect;
  const StageKey key = key_of(stage);
  const auto is_kept = [&] {
    const std::lock_guard lock(kept_->mutex);
    return kept_->stage == key;
  };
  if (!stage.model.added.empty() || effect.empty() || !is_kept())
    return selection::settled(plain, stage, trial);
  InnovationStage best;
  for (const ModelStage& start : trial.starts) {
    const Eigen::VectorXd& theta = start.fitted.theta;
    const StartKey from{effect, {theta.begin(), theta.end()}};
    InnovationStage one;
    {
      const std::lock_guard lock(kept_->mutex);
      const auto known = kept_->stages.find(from);
      if (known != kept_->stages.end()) one = known->second;
    }
    if (!std::isfinite(one.minus_two_log)) {
      InnovationTrial single = trial;
      single.starts = {start};
      one = selection::settled(plain, stage, single);
      const std::lock_guard lock(kept_->mutex);
      if (std::isfinite(one.minus_two_log) && !plain.cancelled()) kept_->stages.emplace(from, one);
    }
    if (one.minus_two_log < best.minus_two_log) best = std::move(one);
  }
  return best;
}

}  // namespace estimator::greybox::selection
