// Check that the records move enough for a diagnosis.
#pragma once

#include "estimator/greybox/fit_dataset.h"

namespace estimator::greybox::selection {

struct Excitation {
  enum class Cause { sufficient, no_motion, command_at_limit };

  Cause cause = Cause::sufficient;
  double travel_m = 0.0;  ///< largest peak to peak of a record
  double noise_floor_m = 0.0;

  [[nodiscard]] bool sufficient() const { return cause == Cause::sufficient; }
};

[[nodiscard]] Excitation excitation_of(const FitDataset& data);

}  // namespace estimator::greybox::selection
