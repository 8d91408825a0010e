// The shift between the clocks of command and position, by a model's motion.
//
//   c(L) = correlation of y(k + w) - y(k) with the modelled speed's mean over k + L ... k + L + w
//
// Unlike the response to the command alone (command_response.h) it knows the plant's time
// constants, and unlike the error of a fit it is blind to what makes the model drift.
#pragma once

#include <vector>

#include "estimator/greybox/dataset.h"

namespace estimator::greybox {

/// Samples by which the command is logged after it acts, beside the `by_response` that the response
/// shows. `speed_mps`: the model's, one per sample. 0: the model's motion does not confirm it.
[[nodiscard]] double command_late_samples(const Dataset& record,
                                          const std::vector<double>& speed_mps, double by_response);

}  // namespace estimator::greybox
