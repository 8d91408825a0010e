// Records that a change in time or a law explains, told before further effects are sought: each
// effect beside the first costs as much as all that is asked here.
#pragma once

#include "estimator/greybox/selection/diagnosis.h"

namespace estimator::greybox::selection {

/// Takes a change in time, or laws, that promise more than any effect beside the model as given,
/// `first`, where they explain the record and are clearly likelier than that and than `held`, the
/// first effect's model by simulations, which does not explain it. `result.search`: that of the
/// model as given. False: `result` is as before.
[[nodiscard]] bool explain_beyond_effects(const SearchContext& context, const ModelStage& first,
                                          const ModelStage& held, Diagnosis& result);

}  // namespace estimator::greybox::selection
