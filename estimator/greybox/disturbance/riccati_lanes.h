// Riccati's recursion for eight noise models side by side, one in each lane of a vector.
//
//   S = P_yy + R,   K = P c / S,   P <- P - K c' P,   P <- A P A' + Q
//
// Each lane does the same operations whatever the others hold and whatever the instruction set, so
// that a noise model's gains do not depend on its company.
#pragma once

#include <array>
#include <cstddef>

#include "estimator/greybox/disturbance/linearisation.h"
#include "plant_sim/ensemble.h"

namespace estimator::greybox::disturbance {

inline constexpr std::size_t kNoiseLanes = 8;
using LaneValues = std::array<double, kNoiseLanes>;

/// Variances of the noise models and their decays.
struct LaneNoise {
  LaneValues decay{};
  LaneValues disturbance_variance{};  ///< of F, stationary: N^2 or (m/s)^2
  LaneValues walk_m2{};               ///< per sample
  LaneValues sensor_m2{};
};

/// Where the results of one noise model go: columns and entries of the whole record.
struct LaneResult {
  double* gain = nullptr;   ///< (states + 1) x samples, by columns
  double* scale = nullptr;  ///< samples
  double log_determinant = 0.0;
};

/// Samples [from, to) of a record.
struct LaneRange {
  const Linearisation* model;
  const char* valid;  ///< one entry per sample of the record
  std::size_t from, to;
  double floor_m;
};

/// The first `lanes` <= kNoiseLanes noise models over a range, from the covariances `start`. Adds
/// to the results' determinants. The set must run here.
void riccati(const LaneRange& range, const std::array<StateMatrix, kNoiseLanes>& start,
             const LaneNoise& noise, std::array<LaneResult, kNoiseLanes>& results,
             std::size_t lanes, plant_sim::InstructionSet set = plant_sim::fastest_here());

}  // namespace estimator::greybox::disturbance
