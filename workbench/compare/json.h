// A comparison as JSON (SI; a missing number is null).
#pragma once

#include <string>

#include "estimator/greybox/validation/comparison.h"

namespace workbench::compare {

namespace validation = estimator::greybox::validation;

/// rms_m (drift-corrected), free_run_rms_m, fit_percent (of the free run), noise_floor_m,
/// one_step_rms_m, whiteness_p, independence_p, worst, and more. `worst`: the range of each
/// variable that stands out most, best first; `stands_out` is false where chance would do.
[[nodiscard]] std::string to_json(const validation::Comparison& comparison);

}  // namespace workbench::compare
