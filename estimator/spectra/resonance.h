// The resonance that a system has and its model lacks, from the ratio of their frequency responses:
//
//   R(s) = H_measured / H_model ~ (b0 + b1 s + b2 s^2) / (1 + a1 s + a2 s^2),    s = i f / f0
//
// about its greatest peak, by weighted least squares that are linear once the denominator of the
// last turn weights them (C. K. Sanathanan, J. Koerner, IEEE Trans. Automatic Control 8 (1963) 56).
// A mass behind a spring gives one: poles at f, damping ratio d, from 1 + 2 d s/f + (s/f)^2. Two
// zeros beside them where the driven part is measured, none where the far one is.
#pragma once

#include <optional>

#include "estimator/spectra/frequency_response.h"

namespace estimator::spectra {

struct Resonance {
  double frequency_Hz = 0.0;
  double frequency_error_Hz = 0.0;  ///< standard error
  double damping_ratio = 0.0;
  double damping_error = 0.0;  ///< standard error
  double peak_ratio = 0.0;     ///< |R| at its greatest over |R| beside it
};

/// `used`: frequencies that count, such as excited(); both responses are of the same frequencies.
/// None without a clear peak in their midst: |R| more than twice that beside it, lightly damped,
/// and explained by the poles many times better than without. A peak whose half-power width 2 d f
/// is below three steps of the spectrum is not told from a spectral line: none either, nor is a
/// lower peak looked at then.
[[nodiscard]] std::optional<Resonance> resonance(const FrequencyResponse& measured,
                                                 const FrequencyResponse& model,
                                                 const std::vector<bool>& used);

}  // namespace estimator::spectra
