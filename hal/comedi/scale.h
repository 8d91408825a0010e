// Conversion between a converter's codes and volts, and between a counter's codes and counts.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace hal::comedi {

/// A converter: code 0 is min_V, max_code is max_V.
struct ConverterSpan {
  double min_V = -10.0;
  double max_V = 10.0;
  std::uint32_t max_code = 4095;

  [[nodiscard]] double step_V() const noexcept { return (max_V - min_V) / max_code; }
  [[nodiscard]] double volts(std::uint32_t code) const noexcept { return min_V + code * step_V(); }
  /// Nearest code, clamped to the range.
  [[nodiscard]] std::uint32_t code(double volts) const noexcept {
    const double code = std::round((volts - min_V) / step_V());
    return static_cast<std::uint32_t>(std::clamp(code, 0.0, static_cast<double>(max_code)));
  }
  /// At an end of the range: the true value may lie beyond.
  [[nodiscard]] bool at_end(std::uint32_t code) const noexcept {
    return code == 0 || code >= max_code;
  }
};

/// value = offset + scale * x; both ways.
struct Linear {
  double scale = 1.0;
  double offset = 0.0;

  [[nodiscard]] double forward(double x) const noexcept { return offset + scale * x; }
  [[nodiscard]] double back(double y) const noexcept { return (y - offset) / scale; }
};

/// Extends a counter beyond its width; it must move less than half the width between readings.
class Unwrap {
 public:
  explicit Unwrap(int bits) noexcept : shift_(32 - bits) {}

  /// Counts since the first call.
  std::int64_t count(std::uint32_t code) noexcept {
    const std::uint32_t aligned = code << shift_;
    if (started_) count_ += static_cast<std::int32_t>(aligned - last_) >> shift_;
    started_ = true;
    last_ = aligned;
    return count_;
  }

 private:
  int shift_;
  bool started_ = false;
  std::uint32_t last_ = 0;
  std::int64_t count_ = 0;
};

}  // namespace hal::comedi
