// Validity of a window's fit and of each estimate, against the healthy errors.
#pragma once

#include <cstddef>

#include "estimator/greybox/tracking/parameter_set.h"
#include "estimator/greybox/tracking/window_fit.h"

namespace estimator::greybox::tracking {

/// The error that exceeds its limit.
struct Misfit {
  enum class Cause { none, position, pressure_error, pressure_offset };

  Cause cause = Cause::none;
  bool inlet = false;    ///< chamber of a pressure cause: in, or out
  double found = 0.0;    ///< position: RMS [m]; pressure: RMS or offset [Pa]
  double healthy = 0.0;  ///< healthy RMS, in the unit of `found`; 0 for an offset
  double limit = 0.0;    ///< ratio to `healthy`; for an offset: Pa

  explicit operator bool() const { return cause != Cause::none; }
};

/// Reason why a fit uses the position alone.
struct PressuresLeftOut {
  enum class Cause { none, not_read, inlet_still, outlet_still, misfit };

  Cause cause = Cause::none;
  Misfit misfit;  ///< for Cause::misfit

  explicit operator bool() const { return cause != Cause::none; }
};

/// Reason why an estimate is invalid, with the figures of that cause.
struct InvalidReason {
  enum class Cause {
    none,
    no_motion,        ///< motion_m, noise_m, window_s
    misfit,           ///< misfit
    needs_pressures,  ///< left_out: the valve gain is not visible in the position alone
    at_bound,         ///< parameter
    not_excited,      ///< parameter, std_error
    not_separable     ///< parameter, std_error, partner, likeness
  };

  Cause cause = Cause::none;
  double motion_m = 0.0;  ///< peak to peak
  double noise_m = 0.0;
  double window_s = 0.0;
  Misfit misfit;
  PressuresLeftOut left_out;
  std::size_t parameter = 0;
  std::size_t partner = 0;  ///< parameter with the most similar effect
  double std_error = 0.0;   ///< search units; infinite: not visible
  double likeness = 0.0;    ///< absolute cosine between the two effects

  explicit operator bool() const { return cause != Cause::none; }
};

/// `most_ratio`: allowed ratio of an RMS error to the healthy one.
[[nodiscard]] Misfit misfit_of(const WindowFitSummary& found, const ErrorScales& baseline,
                               double most_ratio);

/// Tracked parameter `i`: none where it is within its bounds and `std_error` (search units) is at
/// most `most`.
[[nodiscard]] InvalidReason imprecision_of(const WindowFitSummary& found, std::size_t i,
                                           double std_error, double most);

}  // namespace estimator::greybox::tracking
