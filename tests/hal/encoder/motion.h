// Edges of an ideal encoder under a known motion, computed from the motion itself: quarter n begins
// at y = n quarters, and the edge's time solves y(t) = n quarters by bisection.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "hal/encoder/edge_source.h"

namespace hal::encoder::testing {

using Motion = std::function<double(double t_s)>;

inline std::int64_t quarter_at(const Motion& y_quarters, double t_s) {
  return static_cast<std::int64_t>(std::floor(y_quarters(t_s)));
}

/// Levels in quarter n of a motion that starts in quarter 0: (0,0) (1,0) (1,1) (0,1).
inline Levels levels_in(std::int64_t quarter) {
  const std::int64_t phase = ((quarter % 4) + 4) % 4;
  return {phase == 1 || phase == 2, phase == 2 || phase == 3};
}

/// The edge between quarters `from` and `to`, neighbours.
inline Edge edge_between(std::int64_t from, std::int64_t to, std::int64_t t_ns) {
  const Levels before = levels_in(from);
  const Levels after = levels_in(to);
  if (before.a != after.a) return {t_ns, EncoderLine::a, after.a};
  return {t_ns, EncoderLine::b, after.b};
}

/// Every edge from 0 to `end_s`. `step_s`: so short that the motion passes at most one quarter.
inline std::vector<Edge> edges_of(const Motion& y_quarters, double end_s, double step_s) {
  std::vector<Edge> edges;
  std::int64_t quarter = quarter_at(y_quarters, 0.0);
  for (double t_s = 0.0; t_s < end_s; t_s += step_s) {
    const std::int64_t next = quarter_at(y_quarters, t_s + step_s);
    if (next == quarter) continue;
    double low_s = t_s;
    double high_s = t_s + step_s;
    for (int i = 0; i < 60; ++i) {
      const double mid_s = 0.5 * (low_s + high_s);
      (quarter_at(y_quarters, mid_s) == quarter ? low_s : high_s) = mid_s;
    }
    edges.push_back(edge_between(quarter, next, std::llround(high_s * 1e9)));
    quarter = next;
  }
  return edges;
}

}  // namespace hal::encoder::testing
