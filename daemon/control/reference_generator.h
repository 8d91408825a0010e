// The reference in RUN: starts at the rod's position and blends into the signal, so that a start, a
// resume and a change of signal cause no jump.
//
//   r = y0 + w(t / blend_s) (s(t) - y0),  w(x) = x^3 (10 - 15 x + 6 x^2) in [0, 1], then 1
//
// and |dr/dt| <= blend_mps until r meets the signal s; t counts from the start, y0 is the position
// of the rod then (on a change of signal: the reference then). On hold r = y0.
#pragma once

#include <cstdint>

#include "daemon/control/reference_kinds.h"

namespace monitor::control {

class ReferenceGenerator {
 public:
  struct Config {
    double blend_s = 0.0;  ///< 0: no blending
    double blend_mps = 0.05;
    double sample_time_s = 0.005;
  };

  /// `configured` must outlive this object.
  ReferenceGenerator(const Reference& configured, const Config& config) noexcept
      : config_(config), signal_(&configured) {}
  ReferenceGenerator(const ReferenceGenerator&) = delete;
  ReferenceGenerator& operator=(const ReferenceGenerator&) = delete;

  /// Starts the signal from its beginning. `at_once`: without blending.
  void start(double y_m, std::int64_t tick, bool at_once) noexcept;
  /// Switches to another signal, from its beginning; `running`: blends from the present reference.
  void follow(const Sine& signal, std::int64_t tick, bool running) noexcept;
  void hold(double y_m) noexcept;
  /// Blends again from y into the signal, which has continued; a hold continues at y.
  void resume_from(double y_m, std::int64_t tick) noexcept;
  [[nodiscard]] bool holding() const noexcept { return holding_; }
  /// r in m at that tick; ticks must not decrease.
  double at(std::int64_t tick) noexcept;

 private:
  Config config_;
  const Reference* signal_;
  Sine commanded_{0.0, 0.0, 0.0};
  bool holding_ = false;
  bool blending_ = false;
  double from_m_ = 0.0;
  double last_m_ = 0.0;  ///< r at the previous tick
  std::int64_t last_tick_ = 0;
  std::int64_t begin_tick_ = 0;  ///< start of the signal
  std::int64_t blend_tick_ = 0;  ///< start of blending
};

/// A linear ramp from a command to null; see Action::ramp.
class Ramp {
 public:
  explicit Ramp(double duration_s) noexcept : duration_s_(duration_s) {}

  /// `offset_V`: u - null of the last command.
  void start(double offset_V, double t_s) noexcept {
    offset_V_ = offset_V;
    begin_s_ = t_s;
    active_ = true;
  }
  void stop() noexcept { active_ = false; }
  [[nodiscard]] bool active() const noexcept { return active_; }
  /// u - null at t_s.
  [[nodiscard]] double at(double t_s) const noexcept;
  [[nodiscard]] bool over(double t_s) const noexcept;

 private:
  double duration_s_;
  double offset_V_ = 0.0;
  double begin_s_ = 0.0;
  bool active_ = false;
};

}  // namespace monitor::control
