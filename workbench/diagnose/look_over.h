// The backward look over a stage: what is not worth its place goes, what refines an effect may
// come.
#pragma once

#include "workbench/diagnose/trial.h"
#include "workbench/diagnose/workshop.h"

namespace workbench::diagnose {

/// Drops effects, then refinements of effects, as long as the held-out error suffers less than an
/// effect must bring; then tries refinements that did not take part, which have to lower the error
/// of either half of the records when they are fitted to the other half.
void look_over(const Workshop& shop, Stage& stage);

/// Drops effects, the latest first, that do not lower the error of both halves crosswise.
void keep_supported(const Workshop& shop, Stage& stage);

}  // namespace workbench::diagnose
