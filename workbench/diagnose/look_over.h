// The backward look over a stage: what is not worth its place goes, what refines an effect may
// come.
#pragma once

#include "workbench/diagnose/trial.h"
#include "workbench/diagnose/workshop.h"

namespace workbench::diagnose {

/// Drops effects, then refinements of effects, as long as the held-out error suffers less than an
/// effect must bring (and refinements without support.h's support where the error is more than
/// noise); then tries refinements that did not take part, which need that support too.
void look_over(const Workshop& shop, Stage& stage);

}  // namespace workbench::diagnose
