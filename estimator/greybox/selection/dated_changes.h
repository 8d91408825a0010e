// Diagnoses by parameters that change within the record in the place of effects.
#pragma once

#include "estimator/greybox/selection/change_search.h"
#include "estimator/greybox/selection/diagnosis.h"

namespace estimator::greybox::selection {

/// Takes changes where no effect explains the record and they do, alone or beside effects. False:
/// `result` is as before. `likeliest`: the model that the innovations chose among effects.
[[nodiscard]] bool date_changes(const SearchContext& context, const ModelStage& first,
                                const ModelStage& likeliest, Diagnosis& result,
                                ChangesSought sought = ChangesSought::before_laws);

/// The same for a drift that simulations alone find, before effects are sought in its place, beside
/// the model as given, `result.search`. False where the best leaves `most_m` or more, held out.
[[nodiscard]] bool date_drifts(const SearchContext& context, const ModelStage& first, double most_m,
                               Diagnosis& result);

/// Takes changes beside the model as given, settled in `stage`, before a second effect is sought:
/// where they explain the record and are clearly likelier than `held`, the first effect's model by
/// simulations, and than the two most promising effects. False: `result` is as before.
[[nodiscard]] bool date_changes_early(const SearchContext& context, const ModelStage& first,
                                      const InnovationStage& stage, const ModelStage& held,
                                      Diagnosis& result);

}  // namespace estimator::greybox::selection
