// Place of the position sensor on a moving mass in two parts (plant_sim/effects/second_mass.h):
//
//   reading = y + b z
//
// y  driven part, m     z  second mass ahead of it, m     b  0 on the driven part, 1 on the second
#pragma once

#include "plant_sim/ensemble.h"

namespace estimator::greybox {

inline constexpr const char* kSecondMassResonance = "second_mass.resonance_Hz";
inline constexpr const char* kSecondMassSensorRatio = "second_mass.sensor_ratio";
inline constexpr const char* kSecondMassOffset = "second_mass.offset_m";
inline constexpr const char* kSecondMassOffsetSpeed = "second_mass.offset_mps";

/// True where a second mass swings in the lane; also with mass_ratio 0.
[[nodiscard]] inline bool has_second_mass(const plant_sim::Ensemble& ensemble, std::size_t lane) {
  const auto resonance = ensemble.find(kSecondMassResonance);
  return resonance && ensemble.get(*resonance, lane) > 0.0;
}

/// b, per lane; 0 without a second mass.
[[nodiscard]] inline plant_sim::Ensemble::Values sensor_place(const plant_sim::Ensemble& ensemble) {
  plant_sim::Ensemble::Values result{};
  const auto ratio = ensemble.find(kSecondMassSensorRatio);
  for (std::size_t lane = 0; lane < result.size(); ++lane) {
    if (has_second_mass(ensemble, lane)) result[lane] = ensemble.get(*ratio, lane);
  }
  return result;
}

}  // namespace estimator::greybox
