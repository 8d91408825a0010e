#include "estimator/greybox/disturbance/riccati_lanes.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "estimator/greybox/disturbance/predictor.h"

namespace estimator::greybox::disturbance {
namespace {

constexpr std::size_t kStates = kMostStates;
constexpr std::size_t kF = kDisturbance;
/// Samples whose determinants are multiplied before their logarithm is taken.
constexpr std::size_t kPerLogarithm = 16;

using Lanes = double __attribute__((vector_size(kNoiseLanes * sizeof(double))));

struct Span {
  const Linearisation* model;
  const char* valid;
  std::size_t from, to;
  double floor_m;
};

[[gnu::always_inline]] inline void load(Lanes& lanes, const LaneValues& values) {
  std::memcpy(&lanes, values.data(), sizeof lanes);
}

/// P <- A P A' + Q, P and the result symmetric, of which the lower triangle is used. A's row of F
/// is zero but for the decay; `count` states without F.
[[gnu::always_inline]] inline void propagate(Lanes (&p)[kStates][kStates], const StateMatrix& a,
                                             std::size_t count, const Lanes& decay) {
  const auto at = [](std::size_t i) { return static_cast<Eigen::Index>(i); };
  const auto index = [&](std::size_t i) { return i < count ? i : kF; };  // states, then F
  Lanes moved[kStates][kStates];                                         // A P, rows of states
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j <= count; ++j) {
      const std::size_t column = index(j);
      Lanes sum = a(at(i), at(kF)) * (column == kF ? p[kF][kF] : p[kF][column]);
      for (std::size_t k = 0; k < count; ++k) {
        sum += a(at(i), at(k)) * (k >= column ? p[k][column] : p[column][k]);
      }
      moved[i][j] = sum;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      Lanes sum = a(at(j), at(kF)) * moved[i][count];
      for (std::size_t k = 0; k < count; ++k) sum += a(at(j), at(k)) * moved[i][k];
      p[i][j] = sum;
    }
    p[kF][i] = decay * moved[i][count];
  }
  p[kF][kF] = decay * decay * p[kF][kF];
}

[[gnu::always_inline]] inline void run(const Span& span,
                                       const std::array<StateMatrix, kNoiseLanes>& start,
                                       const LaneNoise& noise,
                                       std::array<LaneResult, kNoiseLanes>& results,
                                       std::size_t lanes) {
  const std::size_t count = span.model->states.size();
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
  load(driven, noise.disturbance);
  driven *= 1.0 - decay * decay;
  const double per_floor_m2 = 1.0 / (span.floor_m * span.floor_m);
  Lanes product = decay * 0.0 + 1.0;
  std::size_t factors = 0;
  const auto take_logarithm = [&] {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      results[lane].log_determinant += std::log(product[lane]);
    }
    product = decay * 0.0 + 1.0;
    factors = 0;
  };
  for (std::size_t k = span.from; k < span.to; ++k) {
    const Lanes s_m2 = p[0][0] + sensor_m2;
    const Lanes per_s = 1.0 / s_m2;
    Lanes gain[kStates];
    for (std::size_t i = 0; i < count; ++i) gain[i] = p[i][0] * per_s;
    gain[kF] = p[kF][0] * per_s;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      double* const column = results[lane].gain + k * (count + 1);
      for (std::size_t i = 0; i < count; ++i) column[i] = gain[i][lane];
      column[count] = gain[kF][lane];
      results[lane].scale[k] = span.floor_m / std::sqrt(s_m2[lane]);
    }
    if (span.valid[k] != 0) {
      product *= s_m2 * per_floor_m2;
      if (++factors == kPerLogarithm) take_logarithm();
    }
    const Lanes y_row[kStates] = {p[0][0], p[1][0], p[2][0], p[3][0], p[kF][0]};
    for (std::size_t j = 0; j < count; ++j) p[kF][j] -= gain[kF] * y_row[j];
    p[kF][kF] -= gain[kF] * y_row[kF];
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j <= i; ++j) p[i][j] -= gain[i] * y_row[j];
    }
    propagate(p, span.model->transition[k], count, decay);
    p[0][0] += walk_m2;
    p[kF][kF] += driven;
  }
  take_logarithm();
}

using Run = void (*)(const Span&, const std::array<StateMatrix, kNoiseLanes>&, const LaneNoise&,
                     std::array<LaneResult, kNoiseLanes>&, std::size_t);

void run_baseline(const Span& span, const std::array<StateMatrix, kNoiseLanes>& start,
                  const LaneNoise& noise, std::array<LaneResult, kNoiseLanes>& results,
                  std::size_t lanes) {
  run(span, start, noise, results, lanes);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void run_avx2(const Span& span,
                                      const std::array<StateMatrix, kNoiseLanes>& start,
                                      const LaneNoise& noise,
                                      std::array<LaneResult, kNoiseLanes>& results,
                                      std::size_t lanes) {
  run(span, start, noise, results, lanes);
}

[[gnu::target("avx512f")]] void run_avx512(const Span& span,
                                           const std::array<StateMatrix, kNoiseLanes>& start,
                                           const LaneNoise& noise,
                                           std::array<LaneResult, kNoiseLanes>& results,
                                           std::size_t lanes) {
  run(span, start, noise, results, lanes);
}
#endif

Run fastest_here() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") != 0) return run_avx512;
  if (__builtin_cpu_supports("avx2") != 0) return run_avx2;
#endif
  return run_baseline;
}

}  // namespace

void riccati(const Linearisation& model, const char* valid, std::size_t from, std::size_t to,
             const std::array<StateMatrix, kNoiseLanes>& start, const LaneNoise& noise,
             double floor_m, std::array<LaneResult, kNoiseLanes>& results, std::size_t lanes) {
  static const Run fastest = fastest_here();
  fastest({&model, valid, from, to, floor_m}, start, noise, results, std::min(lanes, kNoiseLanes));
}

}  // namespace estimator::greybox::disturbance
