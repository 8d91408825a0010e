#include "tests/truth/outside.h"

#include <cmath>

namespace truth {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kStep_s = 1e-3;
constexpr std::size_t kApart = 0x51ed270b;  ///< from any seed in use
constexpr std::size_t kLine = 0x2c1b3c6d;

}  // namespace

Disturber::Disturber(const Outside& outside, std::size_t seed)
    : outside_(outside), random_(seed ^ kApart) {
  pulsation_rad_ = random_.uniform(-3.0, 3.0);
  shake_rad_ = random_.uniform(-3.0, 3.0);
  line_rad_ = Random(seed ^ kLine).uniform(-3.0, 3.0);
  now_N_ = outside.force_N * random_.normal();
  next_s_ = kStep_s;
}

double Disturber::force_N(double t_s) {
  double line_N = 0.0;
  if (outside_.line_N > 0.0) {
    line_N = outside_.line_N * std::sin(kTwoPi * outside_.line_Hz * t_s + line_rad_);
  }
  if (outside_.force_N <= 0.0) return line_N;
  const double keep = std::exp(-kTwoPi * outside_.corner_Hz * kStep_s);
  while (t_s >= next_s_) {
    now_N_ = keep * now_N_ + outside_.force_N * std::sqrt(1.0 - keep * keep) * random_.normal();
    next_s_ += kStep_s;
  }
  return now_N_ + line_N;
}

double Disturber::pulsation_Pa(double t_s) const {
  if (outside_.pulsation_Pa <= 0.0) return 0.0;
  return outside_.pulsation_Pa * std::sin(kTwoPi * outside_.pulsation_Hz * t_s + pulsation_rad_);
}

double Disturber::shake_m(double t_s) const {
  if (outside_.shake_m <= 0.0) return 0.0;
  return outside_.shake_m * std::sin(kTwoPi * outside_.shake_Hz * t_s + shake_rad_);
}

}  // namespace truth
