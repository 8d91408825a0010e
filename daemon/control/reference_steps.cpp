#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/control/reference_kinds.h"

namespace monitor::control {
namespace {

/// A time that is a whole number of holds up to rounding belongs to the new level: a tenth of a
/// nanosecond is far above the rounding of t_s and far below any period.
constexpr double kRounding_s = 1e-10;

/// SplitMix64 (Steele, Lea, Flood, OOPSLA 2014): a stateless hash, so that any level is accessible.
std::uint64_t mix(std::uint64_t x) noexcept {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

/// Taps of primitive polynomials of degree 3 to 16 (bit n-1 = x^n), Xilinx XAPP 052.
constexpr std::array<std::uint32_t, 17> kTaps = {0,     0,      0,      0x6,    0xC,   0x14,
                                                 0x30,  0x60,   0xB8,   0x110,  0x240, 0x500,
                                                 0x829, 0x100D, 0x2015, 0x6000, 0xD008};

}  // namespace

Steps::Steps(const ReferenceConfig& config) noexcept
    : centre_m_(config.centre_m),
      amplitude_m_(config.amplitude_m),
      hold_s_(config.hold_s),
      rise_s_(config.rise_s),
      seed_(static_cast<std::uint64_t>(config.seed)) {}

double Steps::level_m(std::int64_t index) const noexcept {
  if (index < 0) return centre_m_;
  const std::uint64_t bits = mix(mix(seed_) + static_cast<std::uint64_t>(index));
  const double unit = static_cast<double>(bits >> 11U) * 0x1p-53;  // in [0, 1)
  return centre_m_ + amplitude_m_ * (2.0 * unit - 1.0);
}

double Steps::at(double t_s) const noexcept {
  const double hold = std::floor((t_s + kRounding_s) / hold_s_);
  const auto index = static_cast<std::int64_t>(hold);
  const double t = t_s - hold * hold_s_;
  const double x = rise_s_ > 0.0 ? std::clamp(t / rise_s_, 0.0, 1.0) : 1.0;
  const double blend = x * x * x * (10.0 + x * (-15.0 + 6.0 * x));
  const double before_m = level_m(index - 1);
  return before_m + blend * (level_m(index) - before_m);
}

Prbs::Prbs(const ReferenceConfig& config)
    : centre_m_(config.centre_m), amplitude_m_(config.amplitude_m), hold_s_(config.hold_s) {
  const auto n = static_cast<unsigned>(config.register_bits);
  const std::uint32_t mask = (1U << n) - 1U;
  const std::uint32_t taps = kTaps.at(n);
  std::uint32_t state = static_cast<std::uint32_t>(config.seed) & mask;
  if (state == 0) state = mask;  // a register of zeros would never change
  bits_.reserve(mask);
  for (std::uint32_t i = 0; i < mask; ++i) {
    bits_.push_back((state >> (n - 1U)) != 0U);
    const auto feedback = static_cast<std::uint32_t>(__builtin_parity(state & taps));
    state = ((state << 1U) | feedback) & mask;
  }
}

double Prbs::at(double t_s) const noexcept {
  const auto index = static_cast<std::size_t>(std::floor((t_s + kRounding_s) / hold_s_));
  return centre_m_ + (bits_[index % bits_.size()] ? amplitude_m_ : -amplitude_m_);
}

}  // namespace monitor::control
