// A tracked parameter that a sensor reads: its mean over the window takes the place of a fit.
#pragma once

#include <cstddef>

#include "estimator/greybox/tracking/window_fit.h"

namespace estimator::greybox::tracking {

struct MeasuredMean {
  double mean = 0.0;
  double std_error = 0.0;  ///< of the mean
};

/// Two samples or more of one quantity, in its own unit.
[[nodiscard]] MeasuredMean measured_mean(const double* values, std::size_t samples);

/// What was fitted, and the parameter `held` in its place among the tracked; `std_error` in search
/// units, of what is known of it without the fit; infinite: nothing is.
[[nodiscard]] WindowFitSummary with_held(WindowFitSummary found, std::size_t held,
                                         double std_error);

}  // namespace estimator::greybox::tracking
