// Effects of the library that are missing beside a parameter that changes in time: neither explains
// the record alone, and each bends what is found of the other.
#pragma once

#include <optional>

#include "estimator/greybox/selection/change_search.h"

namespace estimator::greybox::selection {

/// The effects that, with `change` in the model, at least halve the curve that it leaves, fitted
/// beside it; the stage is returned without the change, which is to be sought anew from there. None
/// where the change leaves nothing, or has explained too little to be believed while effects are
/// missing. `first`: the model as given.
[[nodiscard]] std::optional<ModelStage> effects_beside(const ModelStage& first,
                                                       const ChangeSearch& change);

/// The stage with an effect in the place of its change, where an effect that the model as given
/// does not have was found to change, and hardly does; none where there is no such change.
[[nodiscard]] std::optional<ModelStage> steady_effect(const ModelStage& first,
                                                      const ChangeSearch& change);

}  // namespace estimator::greybox::selection
