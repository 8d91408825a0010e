// Error of the k-step prediction.
//
// Every k samples the model's position is set to the measured one; its other states (speed,
// pressures, spool) continue under the measured command. The error just before the next correction
// is the k-step error. Several offset simulations share the work. A perfect model's k-step error is
// sqrt(2) times the noise, that of two readings.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "estimator/greybox/dataset.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox::validation {

struct KStep {
  std::size_t samples = 1;  ///< k
  double rms_m = std::numeric_limits<double>::quiet_NaN();
  std::size_t count = 0;  ///< number of predictions; 0: no segment is long enough
};

/// k = 1, 10 and 100.
[[nodiscard]] std::vector<KStep> k_step_errors(const plant_sim::ModelFile& model,
                                               const Dataset& record);

}  // namespace estimator::greybox::validation
