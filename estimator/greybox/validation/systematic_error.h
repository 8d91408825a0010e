// Two systematic causes of a drifting model position, and the share of the error that they explain:
// a proportional speed error and a constant one.
//
//   e(k) ~ g z_v(k) + b z_1(k),   z(k+1) = (1 - l Ts) z(k) + Ts x(k),   x = modelled speed, 1
//
// e measured less modelled position under the observer l; g relative, b in m/s.
#pragma once

#include <vector>

#include "estimator/greybox/dataset.h"

namespace estimator::greybox::validation {

enum class ErrorCause { neither, gain, offset, both };

struct SystematicError {
  ErrorCause cause = ErrorCause::neither;  ///< simplest cause that explains at least half
  double share = 0.0;                      ///< share of the squared error that the cause explains
  double gain_ratio = 0.0;  ///< g: the rod moves 1 + g times as far as the model; 0: not used
  double offset_mps = 0.0;  ///< b; 0: not used
  double left_rms_m = 0.0;  ///< error without that share
};

/// `start` of the model that left the error.
[[nodiscard]] SystematicError systematic_error(const Dataset& record,
                                               const std::vector<double>& error_m,
                                               const std::vector<double>& speed_error_mps,
                                               double observer_per_s, PlantStart start);

}  // namespace estimator::greybox::validation
