#include "estimator/greybox/selection/trial_memo.h"

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
  return trials;
}

}  // namespace estimator::greybox::selection
