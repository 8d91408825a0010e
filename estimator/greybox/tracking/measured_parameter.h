// A tracked parameter that a sensor reads: its mean over the window replaces the fit.
#pragma once

#include <cstddef>

#include "estimator/greybox/tracking/window_fit.h"

namespace estimator::greybox::tracking {

struct MeasuredMean {
  double mean = 0.0;
  double std_error = 0.0;  ///< standard error of the mean
};

/// Requires two samples or more of one quantity, in its own unit.
[[nodiscard]] MeasuredMean measured_mean(const double* values, std::size_t samples);

/// Inserts the held parameter `held` into a fit without it. `std_error`, search units: knowledge of
/// the parameter without the fit; infinite: none.
[[nodiscard]] WindowFitSummary with_held(WindowFitSummary found, std::size_t held,
                                         double std_error);

}  // namespace estimator::greybox::tracking
