#include "estimator/greybox/disturbance/riccati_lanes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "estimator/greybox/disturbance/predictor.h"

namespace estimator::greybox::disturbance {
namespace {

constexpr std::size_t kStates = kMostStates;
constexpr std::size_t kF = kDisturbance;
/// Variances of innovations multiplied before their logarithm is taken: in units of the floor's
/// each lies within 1e-19 and 1e19, so that the product neither overflows nor underflows.
constexpr std::size_t kPerLogarithm = 16;

using Lanes = double __attribute__((vector_size(kNoiseLanes * sizeof(double))));

[[gnu::always_inline]] inline void load(Lanes& lanes, const LaneValues& values) {
  std::memcpy(&lanes, values.data(), sizeof lanes);
}

/// P <- A P A' + Q, P and the result symmetric, of which the lower triangle is used. A's row of F
/// is zero but for the decay; `count` states without F.
[[gnu::always_inline]] inline void propagate(Lanes (&p)[kStates][kStates], const StateMatrix& a,
                                             std::size_t count, const Lanes& decay) {
  const auto coefficient = [&](std::size_t i, std::size_t j) {
    return a.coeff(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  };
  const auto index = [&](std::size_t i) { return i < count ? i : kF; };  // states, then F
  Lanes moved[kStates][kStates];                                         // A P, rows of states
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j <= count; ++j) {
      const std::size_t column = index(j);
      Lanes sum = coefficient(i, kF) * p[kF][column];
      for (std::size_t k = 0; k < count; ++k) {
        sum += coefficient(i, k) * (k >= column ? p[k][column] : p[column][k]);
      }
      moved[i][j] = sum;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      Lanes sum = coefficient(j, kF) * moved[i][count];
      for (std::size_t k = 0; k < count; ++k) sum += coefficient(j, k) * moved[i][k];
      p[i][j] = sum;
    }
    p[kF][i] = decay * moved[i][count];
  }
  p[kF][kF] = decay * decay * p[kF][kF];
}

/// What the reading shows of the rod through a play whose gap is `gap_m`: where the rod's deviation
/// x ~ N(0, P_yy) exceeds the gap, max(x - gap, 0).
void pass_play(double gap_m, Lanes (&y_row)[kStates], Lanes& reading_m2) {
  constexpr double kCertain = 6.0;  // standard deviations
  for (std::size_t lane = 0; lane < kNoiseLanes; ++lane) {
    const double sd_m = std::sqrt(std::max(reading_m2[lane], 0.0));
    if (gap_m < -kCertain * sd_m) continue;
    if (gap_m > kCertain * sd_m) {
      for (Lanes& covariance : y_row) covariance[lane] = 0.0;
      reading_m2[lane] = 0.0;
      continue;
    }
    const double z = sd_m > 0.0 ? gap_m / sd_m : 0.0;
    const double passed = 0.5 * std::erfc(z / std::numbers::sqrt2);
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
    const double mean = density - z * passed;
    const double square = (1.0 + z * z) * passed - z * density;
    for (Lanes& covariance : y_row) covariance[lane] *= passed;
    reading_m2[lane] *= std::max(square - mean * mean, passed * passed);
  }
}

[[gnu::always_inline]] inline void run(const LaneRange& range,
                                       const std::array<StateMatrix, kNoiseLanes>& start,
                                       const LaneNoise& noise,
                                       std::array<LaneResult, kNoiseLanes>& results,
                                       std::size_t lanes) {
  const std::size_t count = range.model->states.size();
  Lanes p[kStates][kStates];
  for (std::size_t i = 0; i < kStates; ++i) {
    for (std::size_t j = 0; j < kStates; ++j) {
      for (std::size_t lane = 0; lane < kNoiseLanes; ++lane) {
        p[i][j][lane] = start[lane](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
    }
  }
  Lanes decay;
  Lanes walk_m2;
  Lanes sensor_m2;
  Lanes driven;
  load(decay, noise.decay);
  load(walk_m2, noise.walk_m2);
  load(sensor_m2, noise.sensor_m2);
  load(driven, noise.disturbance_variance);
  driven *= 1.0 - decay * decay;
  const double inverse_floor2_per_m2 = 1.0 / (range.floor_m * range.floor_m);
  Lanes product = Lanes{} + 1.0;
  std::size_t factors = 0;
  const auto take_logarithm = [&] {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      results[lane].log_determinant += std::log(product[lane]);
    }
    product = Lanes{} + 1.0;
    factors = 0;
  };
  for (std::size_t k = range.from; k < range.to; ++k) {
    Lanes y_row[kStates];  // covariances with the reading
    for (std::size_t i = 0; i < kStates; ++i) y_row[i] = p[i][0];
    Lanes reading_m2 = p[0][0];
    if (!range.model->gap_m.empty()) pass_play(range.model->gap_m[k], y_row, reading_m2);
    const Lanes s_m2 = reading_m2 + sensor_m2;
    const Lanes inverse_s_per_m2 = 1.0 / s_m2;
    Lanes gain[kStates];
    for (std::size_t i = 0; i < count; ++i) gain[i] = y_row[i] * inverse_s_per_m2;
    gain[kF] = y_row[kF] * inverse_s_per_m2;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      double* const column = results[lane].gain + k * (count + 1);
      for (std::size_t i = 0; i < count; ++i) column[i] = gain[i][lane];
      column[count] = gain[kF][lane];
      results[lane].scale[k] = range.floor_m / std::sqrt(s_m2[lane]);
    }
    if (range.valid[k] != 0) {
      product *= s_m2 * inverse_floor2_per_m2;
      if (++factors == kPerLogarithm) take_logarithm();
    }
    for (std::size_t j = 0; j < count; ++j) p[kF][j] -= gain[kF] * y_row[j];
    p[kF][kF] -= gain[kF] * y_row[kF];
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j <= i; ++j) p[i][j] -= gain[i] * y_row[j];
    }
    propagate(p, range.model->transition[k], count, decay);
    p[0][0] += walk_m2;
    p[kF][kF] += driven;
  }
  take_logarithm();
}

using Recursion = void (*)(const LaneRange&, const std::array<StateMatrix, kNoiseLanes>&,
                           const LaneNoise&, std::array<LaneResult, kNoiseLanes>&, std::size_t);

void run_baseline(const LaneRange& range, const std::array<StateMatrix, kNoiseLanes>& start,
                  const LaneNoise& noise, std::array<LaneResult, kNoiseLanes>& results,
                  std::size_t lanes) {
  run(range, start, noise, results, lanes);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void run_avx2(const LaneRange& range,
                                      const std::array<StateMatrix, kNoiseLanes>& start,
                                      const LaneNoise& noise,
                                      std::array<LaneResult, kNoiseLanes>& results,
                                      std::size_t lanes) {
  run(range, start, noise, results, lanes);
}

[[gnu::target("avx512f")]] void run_avx512(const LaneRange& range,
                                           const std::array<StateMatrix, kNoiseLanes>& start,
                                           const LaneNoise& noise,
                                           std::array<LaneResult, kNoiseLanes>& results,
                                           std::size_t lanes) {
  run(range, start, noise, results, lanes);
}
#endif

Recursion recursion_for(plant_sim::InstructionSet set) {
  switch (set) {
#if defined(__x86_64__)
    case plant_sim::InstructionSet::avx512:
      return run_avx512;
    case plant_sim::InstructionSet::avx2:
      return run_avx2;
#endif
    default:
      return run_baseline;
  }
}

}  // namespace

void riccati(const LaneRange& range, const std::array<StateMatrix, kNoiseLanes>& start,
             const LaneNoise& noise, std::array<LaneResult, kNoiseLanes>& results,
             std::size_t lanes, plant_sim::InstructionSet set) {
  recursion_for(set)(range, start, noise, results, lanes);
}

}  // namespace estimator::greybox::disturbance
