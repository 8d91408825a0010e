// A record and its models in the frequency domain.
//
//   response   of the speed (y(k+1) - y(k)) / T to the command u(k); the model's is taken from its
//              simulated position over the same windows, so that the motion's shape, the windows
//              and what is not linear count alike in both
//   spectrum   of a residual
//
// Samples while a segment settles are left out; no window reaches over a gap.
#pragma once

#include <optional>
#include <vector>

#include "estimator/greybox/dataset.h"
#include "estimator/spectra/cross_spectra.h"
#include "estimator/spectra/frequency_response.h"
#include "estimator/spectra/resonance.h"

namespace estimator::greybox::validation {

/// Greatest error of a magnitude at a frequency that counts as excited, over the magnitude.
inline constexpr double kExcitedError = 0.3;
/// Power of the speed over that of the sensor's noise, from which on a frequency counts as excited:
/// a controller feeds the noise to the command, and the response would be the controller's.
inline constexpr double kAboveNoise = 25.0;

/// m/s per V; `y_m`: measured or modelled position of each sample of the record. Empty for a record
/// that is too short.
[[nodiscard]] spectra::FrequencyResponse speed_response(const Dataset& record,
                                                        const std::vector<double>& y_m);

/// Frequencies of speed_response() that the motion excites; `noise_floor_m` NaN: not known.
[[nodiscard]] std::vector<bool> excited(const Dataset& record,
                                        const spectra::FrequencyResponse& response,
                                        double noise_floor_m);

/// Power density of a residual, m^2/Hz, in `input`; NaN marks samples that do not count.
[[nodiscard]] spectra::CrossSpectra residual_spectrum(const Dataset& record,
                                                      const std::vector<double>& residual_m);

/// Resonance of the measured response that a model lacks whose free run is off by `free_error_m`.
[[nodiscard]] std::optional<spectra::Resonance> missing_resonance(
    const Dataset& record, const std::vector<double>& free_error_m, double noise_floor_m);

}  // namespace estimator::greybox::validation
