// The reference in RUN: it begins where the rod is and blends into the signal, so that a start, a
// resume and a change of signal are free of jumps.
//
//   r = y0 + w(t / blend_s) (s(t) - y0),  w(x) = x^3 (10 - 15 x + 6 x^2) in [0, 1], then 1
//
// and |dr/dt| <= blend_mps until r has met the signal s; t counts from the start, y0 is where the
// rod stood (a change of signal: where the reference stood). On hold r = y0 for good.
#pragma once

#include <cstdint>

#include "daemon/control/reference_kinds.h"

namespace monitor::control {

class ReferenceGenerator {
 public:
  struct Config {
    double blend_s = 0.0;  ///< 0: the signal at once
    double blend_mps = 0.05;
    double sample_time_s = 0.005;
  };

  /// `configured` outlives this.
  ReferenceGenerator(const Reference& configured, const Config& config) noexcept
      : config_(config), signal_(&configured) {}
  ReferenceGenerator(const ReferenceGenerator&) = delete;
  ReferenceGenerator& operator=(const ReferenceGenerator&) = delete;

  /// The signal from its beginning. `at_once`: without blending.
  void start(double y_m, std::int64_t tick, bool at_once) noexcept;
  /// Another signal, from its beginning; `running`: the reference moves over to it.
  void follow(const Sine& signal, std::int64_t tick, bool running) noexcept;
  void hold(double y_m) noexcept;
  /// Blends anew from y into the signal, which has gone on; a hold goes on at y.
  void resume_from(double y_m, std::int64_t tick) noexcept;
  [[nodiscard]] bool holding() const noexcept { return holding_; }
  /// r in m at that tick; ticks must not go back.
  double at(std::int64_t tick) noexcept;

 private:
  Config config_;
  const Reference* signal_;
  Sine commanded_{0.0, 0.0, 0.0};
  bool holding_ = false;
  bool blending_ = false;
  double from_m_ = 0.0;
  double last_m_ = 0.0;  ///< r of the tick before
  std::int64_t last_tick_ = 0;
  std::int64_t begin_tick_ = 0;  ///< of the signal
  std::int64_t blend_tick_ = 0;  ///< of blending
};

/// A straight line from a command to null; see Action::ramp.
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
