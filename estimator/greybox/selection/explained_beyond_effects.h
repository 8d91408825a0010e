// Records that a change in time or a law explains, told before further effects are sought: each
// effect beside the first costs as much as all that is asked here.
#pragma once

#include "estimator/greybox/selection/diagnosis.h"

namespace estimator::greybox::selection {

/// Takes a change in time, or laws, that promise more than any effect beside the model as given
/// where they explain the record and are clearly likelier than that and than the effects that the
/// search has begun with, which do not explain it; none where the command acts earlier than logged.
/// `result.search`: that of the model as given. False: `result` is as before.
[[nodiscard]] bool explain_beyond_effects(const SearchContext& context, const SearchStart& start,
                                          Diagnosis& result);

}  // namespace estimator::greybox::selection
