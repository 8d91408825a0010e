// Averaged spectra of two series sampled together (P. D. Welch, IEEE Trans. Audio 15 (1967) 70).
//
//   X_k(f)  = sum_n w(n) (x(n) - mean x) exp(-2 pi i f n T)     window k, Hann, half overlapped
//   S_xy(f) = 2 T / (N sum w^2) sum_k conj(X_k) Y_k             one-sided
//
// Windows that overlap are not independent: with Hann windows half over each other the spectra of
// neighbours correlate by 1/36, and N windows count as N / (1 + 2 (N - 1) / (36 N)).
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace estimator::spectra {

/// Consecutive samples, none missing; both of one length.
struct Piece {
  std::span<const double> input;
  std::span<const double> output;
};

struct CrossSpectra {
  std::vector<double> frequency_Hz;         ///< from 1 / window to below half the sample rate
  std::vector<double> input;                ///< power density, input unit^2/Hz
  std::vector<double> output;               ///< output unit^2/Hz
  std::vector<std::complex<double>> cross;  ///< input unit x output unit/Hz
  double averages = 0.0;                    ///< independent ones; 0: no piece is long enough

  [[nodiscard]] bool empty() const { return averages == 0.0; }
};

/// Samples per window, a power of two: at least eight windows fit into `samples`, and a window is
/// no longer than 8 s or 16 samples. 0 for fewer than 128 samples.
[[nodiscard]] std::size_t window_for(std::size_t samples, double sample_time_s);

/// Pieces shorter than `window` samples are left out.
[[nodiscard]] CrossSpectra cross_spectra(std::span<const Piece> pieces, double sample_time_s,
                                         std::size_t window);

}  // namespace estimator::spectra
