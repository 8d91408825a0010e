// Does a disturbance of the rig account for the error that a model leaves, its values as they are?
//
// The values are not fitted: what other values would explain is a fault of the model, and no
// disturbance. A noise model and spectral lines are fitted to the innovations instead. They account
// for the error where the innovations hold no curve over a variable of the motion and no load that
// sets in, and where the disturbance is credible (conclusion.h).
#pragma once

#include <optional>

#include "estimator/greybox/dataset.h"
#include "estimator/greybox/selection/disturbance_report.h"
#include "estimator/greybox/selection/problem.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox::selection {

struct RemainingDisturbance {
  Disturbance disturbance;
  double floor_m = 0.0;  ///< error that sensor and disturbance cause
};

/// Nothing where a disturbance does not account for the error, where it cannot be told, and when
/// cancelled. Of a long record representative segments are judged. Throws
/// config::schema::DataError for a record that is too short, ConfigError for a model that cannot be
/// built.
[[nodiscard]] std::optional<RemainingDisturbance> remaining_disturbance(
    const plant_sim::ModelFile& model, const Dataset& record, const DiagnosisOptions& options);

}  // namespace estimator::greybox::selection
