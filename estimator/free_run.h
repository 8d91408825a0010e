// Judges coefficients on data: the free run simulates the output from the input alone, the one-step
// errors predict each sample from measured ones.
//
//   y_sim(t) = -a1 y_sim(t-1) - ... + b1 u(t-k) + ... [+ c],   cost E = sum (y - y_sim)^2
//
// Source: Song 2002, chapter 3 (E over one period, same control signal).
#pragma once

#include <span>
#include <vector>

#include "estimator/structure.h"

namespace estimator {

/// Simulated output, as long as `u_V`. The first structure.history() samples are the measured ones.
/// `coefficients` in the order of Structure::names(). Diverging models give inf or NaN.
[[nodiscard]] std::vector<double> free_run(const Structure& structure,
                                           std::span<const double> coefficients,
                                           std::span<const double> u_V,
                                           std::span<const double> y_m);

/// y - psi' theta at each sample; NaN for the first structure.history() samples and wherever a
/// measured value is missing.
[[nodiscard]] std::vector<double> one_step_errors(const Structure& structure,
                                                  std::span<const double> coefficients,
                                                  std::span<const double> u_V,
                                                  std::span<const double> y_m);

struct Fit {
  double cost_m2 = 0.0;  ///< sum of squared errors
  double rms_m = 0.0;    ///< over the samples compared; NaN when there are none
  int samples = 0;
};

/// Error of `predicted` against `measured`: sample t of the measurement against sample t - shift of
/// the prediction (shift 1: the simulation runs one sample late). The first `skip` samples of both
/// and missing (NaN) measurements are left out.
[[nodiscard]] Fit compare(std::span<const double> measured_m, std::span<const double> predicted_m,
                          int skip = 0, int shift = 0);

/// Sum and RMS of an error sequence, NaN left out.
[[nodiscard]] Fit summarize(std::span<const double> errors_m);

}  // namespace estimator
