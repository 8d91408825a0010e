#include "plant_sim/instruments.h"

#include <algorithm>
#include <cmath>

namespace plant_sim {
namespace {

constexpr double kTwoPi = 6.283185307179586;

}  // namespace

double Gaussian::next() noexcept {
  has_spare_ = !has_spare_;
  if (!has_spare_) return spare_;
  // 53 bits each; the first in (0, 1], for the logarithm
  const double first = (static_cast<double>(engine_() >> 11U) + 1.0) * 0x1p-53;
  const double second = static_cast<double>(engine_() >> 11U) * 0x1p-53;
  const double radius = std::sqrt(-2.0 * std::log(first));
  spare_ = radius * std::sin(kTwoPi * second);
  return radius * std::cos(kTwoPi * second);
}

double Encoder::read(double y_m) noexcept {
  const double seen_m = noise_m_ > 0.0 ? y_m + noise_m_ * gaussian_.next() : y_m;
  if (!(resolution_m_ > 0.0)) return seen_m;
  return resolution_m_ * std::round(seen_m / resolution_m_);
}

double DacRange::step_V() const noexcept {
  return bits > 0 ? std::ldexp(2.0 * range_V, -bits) : 0.0;
}

double DacRange::apply(double u_V) const noexcept {
  if (std::isnan(u_V)) return 0.0;
  const double held_V = std::clamp(u_V, -range_V, range_V);
  if (bits <= 0) return held_V;
  const double half_codes = std::ldexp(1.0, bits - 1);
  const double code = std::min(std::round(held_V / step_V()), half_codes - 1.0);
  return code * step_V() + 0.0;  // never -0
}

}  // namespace plant_sim
