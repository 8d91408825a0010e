// Frequency response of what is between two series, with its error.
//
//   H1 = S_uy / S_uu      coherence c = |S_uy|^2 / (S_uu S_yy)      n independent averages
//   standard error of |H| over |H|, and of the phase in rad:  sqrt((1 - c) / (2 n c))
//
// H1 has no bias where only the output carries noise. In closed loop the controller feeds noise of
// the output to the input, coherent with it: where it is the greater part of the output, H1 tends
// to the inverse of the controller, and the coherence does not tell. Source: J. S. Bendat, A. G.
// Piersol, Random Data, 4th ed., 6.1 and table 9.6.
#pragma once

#include <complex>
#include <vector>

#include "estimator/spectra/cross_spectra.h"

namespace estimator::spectra {

struct FrequencyResponse {
  std::vector<double> frequency_Hz;
  std::vector<std::complex<double>> value;  ///< output unit per input unit
  std::vector<double> coherence;
  std::vector<double> output;       ///< power density, output unit^2/Hz
  std::vector<double> error_ratio;  ///< |H|'s, and the phase's in rad; infinite: sidelobes alone
  double averages = 0.0;

  [[nodiscard]] bool empty() const { return frequency_Hz.empty(); }
};

[[nodiscard]] FrequencyResponse frequency_response(const CrossSpectra& spectra);

/// The frequencies that are excited: coherence beyond chance, and an error of `most_error` of the
/// magnitude or less.
[[nodiscard]] std::vector<bool> excited(const FrequencyResponse& response, double most_error);

}  // namespace estimator::spectra
