// Floor of every model's error: the noise of a measured position, from its own samples.
//
// Encoder step: the greatest step of which all readings' differences are multiples, allowing for
// the decimals that a CSV keeps.
// Noise: high-order differences leave of a smooth motion next to nothing and of white noise
//
//   E (difference of order m)^2 = binomial(2m, m) sd^2
//
// Energies are taken over short windows. A lower quantile of them, divided by the same quantile of
// pure noise (chi-square with the window's equivalent degrees of freedom), tells the windows where
// a fast motion leaks through; the mean of the others is the answer. It contains the rounding,
// step^2/12 where noise or motion spread the readings over the step. A rod at rest with less noise
// than that hides it: then windows in which the rod moves by steps are used, if there are any, and
// the figure is never below step/sqrt(12). Where no step is found, since a record was interpolated,
// windows of readings that repeat exactly say nothing. Sources: J. von Neumann, Annals of
// Mathematical Statistics 12 (1941) 367, for order 1; B. Widrow, I. Kollar, Quantization Noise,
// chapter 5.
#pragma once

#include <span>

namespace estimator::residual {

struct NoiseFloor {
  double sd_m = 0.0;  ///< rounding included; NaN with fewer than 64 samples
  /// Bound from below: sd_m, or for a slow log the rounding, or without one a small share of what
  /// motion and noise leave together.
  double least_m = 0.0;
  double encoder_step_m = 0.0;  ///< 0: no step found
  bool at_rest = false;         ///< no window moved: the figure is weaker
};

/// NaN marks a missing sample. `sample_time_s` only guards: a rate below 20 Hz leaves no smooth
/// motion between samples, and sd_m is then NaN.
[[nodiscard]] NoiseFloor noise_floor(std::span<const double> y_m, double sample_time_s);

/// The step alone.
[[nodiscard]] double encoder_step_m(std::span<const double> y_m);

}  // namespace estimator::residual
