#include "daemon/control/reference_generator.h"

#include <algorithm>

namespace monitor::control {
namespace {

/// Larger than any rounding error of times on the grid.
constexpr double kRampRounding_s = 1e-9;

}  // namespace

void ReferenceGenerator::start(double y_m, std::int64_t tick, bool at_once) noexcept {
  holding_ = false;
  blending_ = !at_once && config_.blend_s > 0.0;
  from_m_ = last_m_ = y_m;
  last_tick_ = begin_tick_ = blend_tick_ = tick;
}

void ReferenceGenerator::follow(const Sine& signal, std::int64_t tick, bool running) noexcept {
  const double now_m = at(tick);
  commanded_ = signal;
  signal_ = &commanded_;
  if (running) start(now_m, tick, false);
}

void ReferenceGenerator::hold(double y_m) noexcept {
  holding_ = true;
  from_m_ = last_m_ = y_m;
}

void ReferenceGenerator::resume_from(double y_m, std::int64_t tick) noexcept {
  blending_ = config_.blend_s > 0.0;
  from_m_ = last_m_ = y_m;
  last_tick_ = blend_tick_ = tick;
}

double ReferenceGenerator::at(std::int64_t tick) noexcept {
  const auto elapsed_s = static_cast<double>(tick - last_tick_) * config_.sample_time_s;
  last_tick_ = tick;
  if (holding_) return from_m_;
  const double t_s = static_cast<double>(tick - begin_tick_) * config_.sample_time_s;
  const double signal_m = signal_->at(t_s);
  if (blending_) {
    const double blend_s = static_cast<double>(tick - blend_tick_) * config_.sample_time_s;
    const double x = std::clamp(blend_s / config_.blend_s, 0.0, 1.0);
    const double w = x * x * x * (10.0 + x * (-15.0 + 6.0 * x));
    const double wanted_m = from_m_ + w * (signal_m - from_m_);
    const double step_m = config_.blend_mps * elapsed_s;
    last_m_ = std::clamp(wanted_m, last_m_ - step_m, last_m_ + step_m);
    blending_ = x < 1.0 || last_m_ != wanted_m;
  } else {
    last_m_ = signal_m;
  }
  return last_m_;
}

double Ramp::at(double t_s) const noexcept {
  if (over(t_s)) return 0.0;
  return offset_V_ * (1.0 - std::max(0.0, t_s - begin_s_) / duration_s_);
}

bool Ramp::over(double t_s) const noexcept {
  return t_s - begin_s_ >= duration_s_ - kRampRounding_s;
}

}  // namespace monitor::control
