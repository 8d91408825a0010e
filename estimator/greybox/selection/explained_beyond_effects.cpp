#include "estimator/greybox/selection/explained_beyond_effects.h"

#include <algorithm>
#include <cmath>

#include "estimator/greybox/selection/change_search.h"
#include "estimator/greybox/selection/command_lead.h"
#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/dated_changes.h"
#include "estimator/greybox/selection/innovation_curves.h"
#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/greybox/selection/innovation_trials.h"
#include "estimator/greybox/selection/law_search.h"
#include "estimator/greybox/selection/learned_laws.h"
#include "estimator/greybox/selection/simulated_laws.h"

namespace estimator::greybox::selection {
namespace {

/// Gain of an effect over the promise of a law or a change from which on these are not looked into:
/// their linear estimates promise a half to a sixth of what they gain.
constexpr double kFarMore = 6.0;

/// Gain of the model that a search by simulations holds, with the stage's noise model renewed once.
double held_gain_nats(const SearchContext& context, const InnovationStage& stage,
                      const ModelStage& held) {
  if (held.added.empty()) return 0.0;
  const InnovationStage other =
      settled(context, held, stage.noise, Settling::once, wide(context.options.threads));
  return 0.5 * (penalised(stage) - penalised(other));
}

}  // namespace

bool explain_beyond_effects(const SearchContext& context, const SearchStart& start,
                            Diagnosis& result) {
  const ModelStage& first = start.first;
  const ModelStage& held = start.branch.stage;
  // parameters may differ between records before anything changes within one
  if (context.problem.effects_only || context.problem.data.records.size() != 1 ||
      is_explained(context, held) || context.cancelled()) {
    return false;
  }
  const InnovationStage stage =
      settled(context, first, {}, Settling::fully, wide(context.options.threads));
  if (!std::isfinite(stage.minus_two_log)) return false;
  const double by_effects_nats = std::max(kCurve_nats, promised_nats(stage));
  const double by_changes_nats = change_nats(stage);
  const double by_laws_nats = law_nats(context, stage);
  const bool law_first = by_laws_nats > std::max(by_effects_nats, by_changes_nats);
  const bool change_first = by_changes_nats > by_effects_nats && !motion_explains_more(stage);
  if (!law_first && !change_first) return false;
  // a command that changes between the samples of a thinned log can look like a law or a change
  if (find_command_lead(context, start).samples > 0.0) return false;
  const double held_nats = held_gain_nats(context, stage, held);
  const double beyond_nats = std::max(by_laws_nats, by_changes_nats);
  if (held_nats > kFarMore * beyond_nats ||
      (held_nats > beyond_nats && explains_record(context, stage, held))) {
    return false;
  }
  if (law_first && (explain_by_laws(context, start, result) ||
                    learn_law_early(context, first, stage, held, result))) {
    return true;
  }
  return change_first && date_changes_early(context, first, stage, held, result);
}

}  // namespace estimator::greybox::selection
