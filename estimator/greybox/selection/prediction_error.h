// Errors of predictions by one sample: on a disturbed rig they show what is missing. Simulations,
// whose errors hold the disturbance, hardly do.
#pragma once

#include <optional>

#include "estimator/greybox/selection/innovation_search.h"

namespace estimator::greybox::selection {

/// RMS error of the predictions of a finished stage by one sample, m; its lines are predicted too.
[[nodiscard]] double prediction_rms_m(const InnovationStage& stage);

struct PredictionErrors {
  double before_m = 0.0;  ///< RMS, of the model without the effects that were added
  double after_m = 0.0;   ///< RMS, with them
};

/// Without the effects the model has the lines that were found beside them: what these gain is not
/// what is missing. Nothing where no effect was added, or the search was cancelled.
[[nodiscard]] std::optional<PredictionErrors> prediction_errors(const SearchContext& context,
                                                                const InnovationSearch& search);

}  // namespace estimator::greybox::selection
