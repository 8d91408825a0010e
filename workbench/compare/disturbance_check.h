// Does a disturbance of the rig account for what a model leaves, as a diagnosis of the record would
// say?
#pragma once

#include <functional>
#include <optional>

#include "estimator/greybox/selection/remaining_disturbance.h"
#include "estimator/greybox/validation/comparison.h"
#include "plant_sim/model_file.h"

namespace workbench::compare {

struct DisturbanceCheck {
  bool asked = false;  ///< false: it is not known
  std::optional<estimator::greybox::selection::RemainingDisturbance> found = {};
};

/// Asked where the comparison is above the noise floor, under the usual observer, and not off by a
/// plain gain or offset: takes seconds. `cancel` may be empty.
[[nodiscard]] DisturbanceCheck check_disturbance(
    const plant_sim::ModelFile& model, const estimator::greybox::validation::Comparison& comparison,
    unsigned threads, const std::function<bool()>& cancel = {});

}  // namespace workbench::compare
