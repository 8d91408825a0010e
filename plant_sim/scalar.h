// Scalar types of the physics: double, and SIMD vectors of eight doubles (simd_vector.h), eight
// parameter sets on one input.
//
// Code templated on Scalar uses + - * / and the functions below, never a branch on a value:
// select() takes both sides. Each lane does exactly the operations of the double version.
#pragma once

#include <cmath>
#include <cstddef>

#include "plant_sim/elementary.h"
#include "plant_sim/simd_vector.h"

namespace plant_sim {

inline double select(bool mask, double yes, double no) { return mask ? yes : no; }
inline double min(double a, double b) { return a < b ? a : b; }
inline double max(double a, double b) { return a > b ? a : b; }
inline double sqrt(double a) { return std::sqrt(a); }
inline double exp(double a) { return elementary::exp(a); }
inline double decay(double a) { return elementary::decay(a); }
inline double log(double a) { return elementary::log(a); }
inline double tanh(double a) { return elementary::tanh(a); }
inline double sin(double a) {
  return std::fabs(a) <= elementary::kSinReach ? elementary::sin(a) : std::sin(a);
}
inline double ceil(double a) { return std::ceil(a); }
inline double floor(double a) { return std::floor(a); }
inline double abs(double a) { return std::fabs(a); }
inline bool all(bool mask) { return mask; }
/// Largest lane.
inline double reduce_max(double a) { return a; }
/// at(index), where `at` returns a number for an integer index; lanes have individual indices.
template <class At>
double pick(double index, At&& at) {
  return at(static_cast<std::size_t>(index));
}

/// Limited to lo..hi; NaN becomes lo.
template <class Scalar>
Scalar clamp(const Scalar& a, const Scalar& lo, const Scalar& hi) {
  return min(max(a, lo), hi);
}

}  // namespace plant_sim
