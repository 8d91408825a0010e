// Correction of a simulation towards the readings: of the position, by the weak observer, and while
// a segment settles, of the speed too on an axis driven by force, where an error of it lasts for
// mass over damping; oil would hold a rod at once. Position and speed then follow the
// growing-memory filter of degree 1, the line through all samples so far:
//
//   y += 2 (2 n - 1) / (n (n + 1)) e,   v += 6 / (n (n + 1)) e / Ts,   e of the n-th sample
//
// Source: E. Brookner, Tracking and Kalman Filtering Made Easy (1998), 7.2.
#pragma once

#include <cstddef>
#include <optional>

#include "estimator/greybox/dataset.h"
#include "plant_sim/ensemble.h"

namespace estimator::greybox {

/// Speeds at which the ensemble's plant can begin.
[[nodiscard]] inline PlantStart plant_start(const plant_sim::Ensemble& ensemble) {
  return ensemble.find_state("v_mps") && !ensemble.find_state("pressure_in_Pa")
             ? PlantStart::any_speed
             : PlantStart::held_by_oil;
}

class ObserverCorrection {
 public:
  using Ensemble = plant_sim::Ensemble;

  /// `record` must outlive it.
  ObserverCorrection(const Ensemble& ensemble, const Dataset& record, double observer_per_s)
      : record_(record), observer_per_s_(observer_per_s) {
    if (plant_start(ensemble) == PlantStart::any_speed) speed_ = ensemble.find_state("v_mps");
  }

  [[nodiscard]] ObserverGain gain(std::size_t k) const noexcept {
    return record_.observer_gain(k, observer_per_s_,
                                 speed_ ? PlantStart::any_speed : PlantStart::held_by_oil);
  }

  /// True while the speed follows the readings too.
  [[nodiscard]] bool finds_speed(std::size_t k) const noexcept { return gain(k).speed_per_s > 0.0; }

  /// Corrects every lane by its error at sample k, measured less modelled position.
  void apply(Ensemble& ensemble, std::size_t k, const Ensemble::Values& error_m) const {
    const ObserverGain by = gain(k);
    if (!(by.position > 0.0)) return;
    Ensemble::Values shift_m{};
    for (std::size_t lane = 0; lane < Ensemble::kLanes; ++lane) {
      shift_m[lane] = by.position * error_m[lane];
    }
    ensemble.shift(shift_m);
    if (!(by.speed_per_s > 0.0)) return;
    Ensemble::Values speed_mps = ensemble.state(*speed_);
    for (std::size_t lane = 0; lane < Ensemble::kLanes; ++lane) {
      speed_mps[lane] += by.speed_per_s * error_m[lane];
    }
    ensemble.set_state(*speed_, speed_mps);
  }

 private:
  const Dataset& record_;
  double observer_per_s_;
  std::optional<std::size_t> speed_;  ///< where it is free
};

}  // namespace estimator::greybox
