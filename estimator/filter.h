// Butterworth low-, high- and band-pass filters as a chain of second-order sections, by bilinear
// transform with the corner frequencies pre-warped; streaming, in fixed memory.
//
// Section:  v = b0 x + s1;  s1 = b1 x - a1 v + s2;  s2 = b2 x - a2 v   (transposed direct form II)
// Source: A. V. Oppenheim, R. W. Schafer, Discrete-Time Signal Processing, chapter 7.
#pragma once

#include <array>

namespace estimator {

enum class Band { low_pass, high_pass, band_pass };

struct FilterDesign {
  Band band = Band::low_pass;
  int order = 4;           ///< 1 to 8; a band-pass has twice as many poles
  double low_Hz = 0.0;     ///< lower corner (-3 dB) of high- and band-pass
  double high_Hz = 0.0;    ///< upper corner (-3 dB) of low- and band-pass
  double sample_Hz = 0.0;  ///< sampling rate; corners lie in (0, sample_Hz / 2)
};

struct Biquad {
  double b0 = 1.0, b1 = 0.0, b2 = 0.0, a1 = 0.0, a2 = 0.0;
};

class Filter {
 public:
  static constexpr int kMaxSections = 8;

  /// Passes everything.
  Filter() = default;
  /// Throws config::schema::UsageError for an order or a corner out of range.
  explicit Filter(const FilterDesign& design);

  /// The first sample after construction or reset() is taken as having been there forever, so a
  /// constant offset causes no start-up transient.
  double push(double value) noexcept;
  void reset() noexcept { started_ = false; }

  [[nodiscard]] int sections() const noexcept { return count_; }
  [[nodiscard]] const Biquad& section(int i) const noexcept { return biquads_[i]; }

 private:
  void settle(double value) noexcept;

  int count_ = 0;
  bool started_ = false;
  std::array<Biquad, kMaxSections> biquads_{};
  std::array<double, kMaxSections> s1_{};
  std::array<double, kMaxSections> s2_{};
};

}  // namespace estimator
