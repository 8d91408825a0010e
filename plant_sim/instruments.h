// Instruments between plant and computer: the encoder's steps and noise, the D/A
// converter's bits and range. Seeded and self-contained: the same seed gives the same bytes
// everywhere.
#pragma once

#include <cstdint>
#include <random>

namespace plant_sim {

/// Standard normal numbers from a 64-bit Mersenne twister by Box and Muller's transform.
class Gaussian {
 public:
  explicit Gaussian(std::uint64_t seed) : engine_(seed) {}
  double next() noexcept;

 private:
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

/// reading = resolution round((y + noise) / resolution); a resolution of 0 means none.
class Encoder {
 public:
  Encoder(double resolution_m, double noise_m, std::uint64_t seed)
      : resolution_m_(resolution_m), noise_m_(noise_m), gaussian_(seed) {}
  double read(double y_m) noexcept;

 private:
  double resolution_m_;
  double noise_m_;  ///< standard deviation
  Gaussian gaussian_;
};

/// A D/A converter of 2^bits codes over -range_V .. +range_V less one code; 0 bits = only the
/// range.
struct DacRange {
  int bits = 12;
  double range_V = 10.0;

  /// Output voltage for the requested one; NaN gives 0 V.
  [[nodiscard]] double apply(double u_V) const noexcept;
  /// One code's step; 0 when bits is 0.
  [[nodiscard]] double step_V() const noexcept;
};

}  // namespace plant_sim
