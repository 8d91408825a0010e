// Diagnoses by parameters that change within the record in the place of effects.
#pragma once

#include "estimator/greybox/selection/change_search.h"
#include "estimator/greybox/selection/diagnosis.h"

namespace estimator::greybox::selection {

/// Takes changes where no effect explains the record and they do, alone or beside effects. False:
/// `result` is as before. `likely`: a model whose effects were dropped; without effects: none was.
[[nodiscard]] bool date_changes(const SearchContext& context, const ModelStage& first,
                                const ModelStage& likely, Diagnosis& result,
                                ChangesSought sought = ChangesSought::before_laws);

}  // namespace estimator::greybox::selection
