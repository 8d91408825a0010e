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

}  // namespace estimator::greybox::selection
