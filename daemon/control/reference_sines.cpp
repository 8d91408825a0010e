#include <algorithm>
#include <cmath>
#include <numbers>

#include "daemon/control/reference_kinds.h"

namespace monitor::control {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
/// Search grid for the peak of a multisine: a hundredth of the fastest sine, over a hundred of the
/// slowest or this many points.
constexpr double kPointsPerCycle = 100.0;
constexpr double kMaxPoints = 200000.0;

}  // namespace

Sine::Sine(double centre_m, double amplitude_m, double frequency_Hz) noexcept
    : centre_m_(centre_m), amplitude_m_(amplitude_m), frequency_Hz_(frequency_Hz) {}

double Sine::at(double t_s) const noexcept {
  return centre_m_ + amplitude_m_ * std::sin(kTurn_rad * frequency_Hz_ * t_s);
}

Triangle::Triangle(double centre_m, double amplitude_m, double frequency_Hz) noexcept
    : centre_m_(centre_m), amplitude_m_(amplitude_m), frequency_Hz_(frequency_Hz) {}

double Triangle::at(double t_s) const noexcept {
  const double cycles = frequency_Hz_ * t_s + 0.25;
  const double within = cycles - std::floor(cycles);
  return centre_m_ + amplitude_m_ * (1.0 - 4.0 * std::abs(within - 0.5));
}

Multisine::Multisine(double centre_m, double amplitude_m, std::vector<double> frequencies_Hz)
    : centre_m_(centre_m), frequencies_Hz_(std::move(frequencies_Hz)) {
  const auto [slowest, fastest] =
      std::minmax_element(frequencies_Hz_.begin(), frequencies_Hz_.end());
  const double step_s = 1.0 / (kPointsPerCycle * *fastest);
  const double points = std::min(100.0 / *slowest / step_s, kMaxPoints);
  double peak = 0.0;
  for (int i = 0; i < static_cast<int>(points); ++i) {
    peak = std::max(peak, std::abs(sum(i * step_s)));
  }
  scale_m_ = amplitude_m / peak;
}

double Multisine::phase_rad(std::size_t index) const noexcept {
  const double k = static_cast<double>(index);
  return -std::numbers::pi * k * (k + 1.0) / static_cast<double>(frequencies_Hz_.size());
}

double Multisine::sum(double t_s) const noexcept {
  double total = 0.0;
  for (std::size_t i = 0; i < frequencies_Hz_.size(); ++i) {
    total += std::sin(kTurn_rad * frequencies_Hz_[i] * t_s + phase_rad(i));
  }
  return total;
}

double Multisine::at(double t_s) const noexcept { return centre_m_ + scale_m_ * sum(t_s); }

Chirp::Chirp(const ReferenceConfig& config) noexcept
    : centre_m_(config.centre_m),
      amplitude_m_(config.amplitude_m),
      start_Hz_(config.frequency_Hz),
      end_Hz_(config.frequency_end_Hz),
      sweep_s_(config.sweep_s) {}

double Chirp::at(double t_s) const noexcept {
  const double sweeps = std::floor(t_s / sweep_s_);
  const double t = t_s - sweeps * sweep_s_;
  const double cycles = sweeps * 0.5 * (start_Hz_ + end_Hz_) * sweep_s_ + start_Hz_ * t +
                        0.5 * (end_Hz_ - start_Hz_) / sweep_s_ * t * t;
  return centre_m_ + amplitude_m_ * std::sin(kTurn_rad * cycles);
}

}  // namespace monitor::control
