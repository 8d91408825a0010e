// Speed at the start of a segment that begins in motion, on an axis driven by force: an error of it
// lasts for mass over damping, where oil would hold a rod at once. While the segment settles,
// position and speed follow the growing-memory filter of degree 1, the line through all samples so
// far in place of the position alone:
//
//   y += 2 (2 n - 1) / (n (n + 1)) e,   v += 6 / (n (n + 1)) e / Ts,   e of the n-th sample
//
// Source: E. Brookner, Tracking and Kalman Filtering Made Easy (1998), 7.2.
#pragma once

#include <cstddef>
#include <optional>

#include "plant_sim/ensemble.h"

namespace estimator::greybox {

class StartingSpeed {
 public:
  using Ensemble = plant_sim::Ensemble;

  explicit StartingSpeed(const Ensemble& ensemble) {
    if (!ensemble.find_state("pressure_in_Pa")) speed_ = ensemble.find_state("v_mps");
  }

  /// True where the plant has such a speed.
  [[nodiscard]] bool is_free() const noexcept { return speed_.has_value(); }

  void begin() noexcept { samples_ = 0.0; }
  /// Corrects position and speed of every lane by its error, measured less modelled position.
  /// Returns the position's gain.
  double correct(Ensemble& ensemble, const Ensemble::Values& error_m, double sample_time_s) {
    samples_ += 1.0;
    const double all = samples_ * (samples_ + 1.0);
    const double gain = 2.0 * (2.0 * samples_ - 1.0) / all;
    Ensemble::Values by_m{};
    Ensemble::Values speed_mps = ensemble.state(*speed_);
    for (std::size_t lane = 0; lane < Ensemble::kLanes; ++lane) {
      by_m[lane] = gain * error_m[lane];
      // one sample shows no speed
      if (samples_ > 1.0) speed_mps[lane] += 6.0 / all * error_m[lane] / sample_time_s;
    }
    ensemble.shift(by_m);
    ensemble.set_state(*speed_, speed_mps);
    return gain;
  }

 private:
  std::optional<std::size_t> speed_;
  double samples_ = 0.0;  ///< number of samples since the segment began
};

}  // namespace estimator::greybox
