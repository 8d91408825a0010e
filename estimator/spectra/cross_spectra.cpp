#include "estimator/spectra/cross_spectra.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <unsupported/Eigen/FFT>

namespace estimator::spectra {
namespace {

using Spectrum = std::vector<std::complex<double>>;

constexpr std::size_t kLeastSamples = 128;
constexpr double kWindows = 4.5;  ///< lengths of a window: eight of them, half overlapped
constexpr double kLongest_s = 8.0;
constexpr double kNeighbours = 1.0 / 36.0;  ///< correlation of neighbours' spectra

std::vector<double> hann(std::size_t n) {
  std::vector<double> w(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = static_cast<double>(i) / static_cast<double>(n);
    w[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * turn);
  }
  return w;
}

class Windows {
 public:
  explicit Windows(std::size_t n) : weights_(hann(n)), tapered_(n) {
    fft_.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  }

  [[nodiscard]] double square_sum() const {
    return std::inner_product(weights_.begin(), weights_.end(), weights_.begin(), 0.0);
  }
  Spectrum of(std::span<const double> x) {
    const double mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) tapered_[i] = weights_[i] * (x[i] - mean);
    Spectrum out;
    fft_.fwd(out, tapered_);
    return out;
  }

 private:
  std::vector<double> weights_;
  std::vector<double> tapered_;
  Eigen::FFT<double> fft_;
};

}  // namespace

std::size_t window_for(std::size_t samples, double sample_time_s) {
  if (samples < kLeastSamples) return 0;
  const double most = std::min(static_cast<double>(samples) / kWindows, kLongest_s / sample_time_s);
  return std::bit_floor(static_cast<std::size_t>(std::max(most, 16.0)));
}

CrossSpectra cross_spectra(std::span<const Piece> pieces, double sample_time_s,
                           std::size_t window) {
  CrossSpectra out;
  if (window < 4) return out;
  const std::size_t bins = window / 2 - 1;
  out.input.assign(bins, 0.0);
  out.output.assign(bins, 0.0);
  out.cross.assign(bins, 0.0);
  Windows windows(window);
  std::size_t count = 0;
  for (const Piece& piece : pieces) {
    for (std::size_t at = 0; at + window <= piece.input.size(); at += window / 2, ++count) {
      const Spectrum x = windows.of(piece.input.subspan(at, window));
      const Spectrum y = windows.of(piece.output.subspan(at, window));
      for (std::size_t i = 0; i < bins; ++i) {
        out.input[i] += std::norm(x[i + 1]);
        out.output[i] += std::norm(y[i + 1]);
        out.cross[i] += std::conj(x[i + 1]) * y[i + 1];
      }
    }
  }
  if (count == 0) return {};
  const auto n = static_cast<double>(count);
  const double scale = 2.0 * sample_time_s / (windows.square_sum() * n);
  for (std::size_t i = 0; i < bins; ++i) {
    out.frequency_Hz.push_back(static_cast<double>(i + 1) /
                               (static_cast<double>(window) * sample_time_s));
    out.input[i] *= scale;
    out.output[i] *= scale;
    out.cross[i] *= scale;
  }
  out.averages = n / (1.0 + 2.0 * (n - 1.0) / n * kNeighbours);
  return out;
}

}  // namespace estimator::spectra
