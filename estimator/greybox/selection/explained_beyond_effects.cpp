#include "estimator/greybox/selection/explained_beyond_effects.h"

#include <algorithm>
#include <cmath>

#include "estimator/greybox/selection/change_search.h"
#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/dated_changes.h"
#include "estimator/greybox/selection/innovation_curves.h"
#include "estimator/greybox/selection/innovation_trials.h"
#include "estimator/greybox/selection/law_search.h"
#include "estimator/greybox/selection/learned_laws.h"

namespace estimator::greybox::selection {

bool explain_beyond_effects(const SearchContext& context, const ModelStage& first,
                            const ModelStage& held, Diagnosis& result) {
  // parameters may differ between records before anything changes within one
  if (context.problem.effects_only || context.problem.data.records.size() != 1 ||
      is_explained(context, held) || context.cancelled()) {
    return false;
  }
  const InnovationStage stage =
      settled(context, first, {}, kMostTurns, wide(context.options.threads));
  if (!std::isfinite(stage.minus_two_log)) return false;
  const double by_effects_nats = std::max(kCurve_nats, promised_nats(stage));
  const double by_changes_nats = change_nats(stage);
  const double by_laws_nats = law_nats(context, stage);
  if (by_laws_nats > std::max(by_effects_nats, by_changes_nats) &&
      learn_law_early(context, first, stage, held, result)) {
    return true;
  }
  return by_changes_nats > by_effects_nats && !motion_explains_more(stage) &&
         date_changes_early(context, first, stage, held, result);
}

}  // namespace estimator::greybox::selection
