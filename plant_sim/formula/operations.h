// Operators and functions of a formula, for double and for SIMD lanes.
//
// Truth is 1, everything but 0 is true. Nothing branches on a value: if(condition, yes, no) finds
// both sides and takes one, so that each lane does exactly the operations of the double version.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "plant_sim/scalar.h"

namespace plant_sim::formula {

enum class Op : std::uint8_t {
  add,
  subtract,
  multiply,
  divide,
  power,
  negate,
  less,
  less_equal,
  greater,
  greater_equal,
  equal,
  unequal,
  both,
  either,
  choose,
  abs,
  sign,
  sqrt,
  exp,
  ln,
  log10,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  sinh,
  cosh,
  tanh,
  floor,
  atan2,
  min,
  max,
  multiply_add,  ///< a b + c, both rounded
  limit          ///< max(min(a, b), c)
};

/// f of doubles, lane by lane.
template <class S, class F>
S by_lane(F f, const S& a) {
  if constexpr (std::is_same_v<S, double>) {
    return f(a);
  } else {
    S result;
    for (std::size_t i = 0; i < S::kSize; ++i) result.set(i, f(a[i]));
    return result;
  }
}
template <class S, class F>
S by_lane(F f, const S& a, const S& b) {
  if constexpr (std::is_same_v<S, double>) {
    return f(a, b);
  } else {
    S result;
    for (std::size_t i = 0; i < S::kSize; ++i) result.set(i, f(a[i], b[i]));
    return result;
  }
}

/// a^b; for finite a > 0 and b to within 1.5 + 2 |b ln a| units in the last place.
template <class S>
S power(const S& a, const S& b) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  const auto plain = (a > S(0.0)) & ((a <= S(kLargest)) & (abs(b) <= S(kLargest)));
  const auto vanishes = (a <= S(0.0)) & ((a >= S(0.0)) & (b > S(0.0)));
  const S from_exp = exp(select(plain, b, S(0.0)) * log(select(plain, a, S(1.0))));
  const auto known = select(plain, S(1.0), select(vanishes, S(1.0), S(0.0))) > S(0.0);
  const S result = select(plain, from_exp, S(0.0));
  if (all(known)) return result;
  return select(known, result, by_lane([](double x, double y) { return std::pow(x, y); }, a, b));
}

/// One operation; surplus operands are ignored.
template <class S>
S apply(Op op, const S& a, const S& b, const S& c) {
  const S zero = 0.0;
  const S one = 1.0;
  const auto is_zero = [&](const S& x) { return (x <= zero) & (x >= zero); };
  switch (op) {
    case Op::add:
      return a + b;
    case Op::subtract:
      return a - b;
    case Op::multiply:
      return a * b;
    case Op::divide:
      return a / b;
    case Op::power:
      return power(a, b);
    case Op::negate:
      return -a;
    case Op::less:
      return select(a < b, one, zero);
    case Op::less_equal:
      return select(a <= b, one, zero);
    case Op::greater:
      return select(a > b, one, zero);
    case Op::greater_equal:
      return select(a >= b, one, zero);
    case Op::equal:
      return select((a <= b) & (a >= b), one, zero);
    case Op::unequal:
      return select((a <= b) & (a >= b), zero, one);
    case Op::both:
      return select(is_zero(a), zero, select(is_zero(b), zero, one));
    case Op::either:
      return select(is_zero(a), select(is_zero(b), zero, one), one);
    case Op::choose:
      return select(is_zero(a), c, b);
    case Op::abs:
      return abs(a);
    case Op::sign:
      return select(a > zero, one, select(a < zero, -one, zero));
    case Op::sqrt:
      return sqrt(a);
    case Op::exp:
      return exp(a);
    case Op::ln:
      return log(a);
    case Op::log10:
      return by_lane([](double x) { return std::log10(x); }, a);
    case Op::sin:
      return sin(a);
    case Op::cos:
      return by_lane([](double x) { return std::cos(x); }, a);
    case Op::tan:
      return by_lane([](double x) { return std::tan(x); }, a);
    case Op::asin:
      return by_lane([](double x) { return std::asin(x); }, a);
    case Op::acos:
      return by_lane([](double x) { return std::acos(x); }, a);
    case Op::atan:
      return by_lane([](double x) { return std::atan(x); }, a);
    case Op::sinh:
      return by_lane([](double x) { return std::sinh(x); }, a);
    case Op::cosh:
      return by_lane([](double x) { return std::cosh(x); }, a);
    case Op::tanh:
      return tanh(a);
    case Op::floor:
      return floor(a);
    case Op::atan2:
      return by_lane([](double x, double y) { return std::atan2(x, y); }, a, b);
    case Op::min:
      return min(a, b);
    case Op::max:
      return max(a, b);
    case Op::multiply_add:
      return a * b + c;
    case Op::limit:
      return max(min(a, b), c);
  }
  return zero;
}

}  // namespace plant_sim::formula
