// exp, log, sin and tanh of a double or of a machine word of doubles (GCC vectors), with the very
// same operations: lanes and single runs agree bit for bit, on every machine. Errors stay below 1.5
// units in the last place of the result, of sin and tanh below 3 (sin up to |x| = 1e6; beyond,
// callers take the C library's).
//
//   exp x = 2^n e^r,         n = round(x / ln 2),  r = x - n ln 2,  e^r = 1 + r + r^2 P(r)
//   log x = e ln 2 + log(1 + f), 1 + f = x / 2^e in [sqrt 1/2, sqrt 2):
//           log(1 + f) = f - f^2/2 + s (f^2/2 + R(s^2)),  s = f / (2 + f)
//   sin x = (-1)^n sin r,    n = round(x / pi),  r = x - n pi,  sin r = r + r^3 Q(r^2)
//   tanh |x| = -t / (2 + t), t = e^(-2|x|) - 1 = 2^n (e^r - 1) + (2^n - 1)
//
// P and Q are minimax (Remez) polynomials: |e^r - p| < 4e-18, relative error of sin < 3e-22 up to
// rounding. ln 2 and pi are subtracted in parts whose products with n are exact.
// Sources: Muller, Elementary Functions (2016); R and its coefficients: fdlibm, e_log.c (Sun,
// 1993).
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace plant_sim::elementary {

/// The integers of the size of V's elements.
template <class V>
struct BitsOf {
  static V sample();
  using Type = decltype(sample() < sample());
};
template <>
struct BitsOf<double> {
  using Type = std::int64_t;
};

/// Added to a number below 2^51, it leaves the nearest integer in the low bits.
inline constexpr double kRounder = 6755399441055744.0;  // 1.5 * 2^52

/// 2^n for a whole n from -1022 to 1023, by writing the exponent.
template <class V>
inline V power_of_two(V n) {
  using Bits = typename BitsOf<V>::Type;
  const Bits low = __builtin_bit_cast(Bits, n + kRounder);
  return __builtin_bit_cast(V, (low + 1023) << 52);
}

/// e^(x - n ln 2) - 1, n = round(x / ln 2).
template <class V>
inline V exp_of_rest_less_one(V x, V n) {
  const V r = (x - n * 0.6931471803691238) - n * 1.9082149292705877e-10;
  const V r2 = r * r;
  const V r4 = r2 * r2;
  const V p = (0.5000000000000012 + r * 0.166666666666667) +
              r2 * (0.041666666666515494 + r * 0.008333333333307137) +
              r4 * ((0.0013888888946996254 + r * 0.00019841269917553634) +
                    r2 * (2.4801489960856445e-05 + r * 2.755721613746e-06) +
                    r4 * (2.763127440438842e-07 + r * 2.511791522991621e-08));
  return r + r2 * p;
}

/// e^(x - n ln 2), n = round(x / ln 2).
template <class V>
inline V exp_of_rest(V x, V n) {
  return 1.0 + exp_of_rest_less_one(x, n);
}

template <class V>
inline V exp(V x) {
  constexpr double kLargest = 709.782712893384;
  constexpr double kSmallest = -745.2;
  const V n = (x * 1.4426950408889634 + kRounder) - kRounder;
  // two factors: the result may be subnormal, or above 2^1023
  const V half = ((n * 0.5) + kRounder) - kRounder;
  const V y = (exp_of_rest(x, n) * power_of_two<V>(half)) * power_of_two<V>(n - half);
  const V low = x < kSmallest ? V{} : y;
  return x > kLargest ? V{} + std::numeric_limits<double>::infinity() : low;
}

/// e^-x for 0 <= x <= 700, bit-equal, without the branches for tiny and large results.
template <class V>
inline V decay(V x) {
  const V n = (-x * 1.4426950408889634 + kRounder) - kRounder;
  return exp_of_rest<V>(-x, n) * power_of_two<V>(n);
}

template <class V>
inline V tanh(V x) {
  constexpr double kSaturated = 20.0;  // tanh 20 is 1 within half a unit in the last place
  const V size = x < 0.0 ? -x : x;
  const V twice = -2.0 * (size > kSaturated ? V{} + kSaturated : size);
  const V n = (twice * 1.4426950408889634 + kRounder) - kRounder;
  const V scale = power_of_two<V>(n);
  const V t = scale * exp_of_rest_less_one(twice, n) + (scale - 1.0);
  const V y = t / (2.0 + t);
  const V positive = x > 0.0 ? -y : x;  // zeros and NaN as they are
  return x < 0.0 ? y : positive;
}

template <class V>
inline V log(V x) {
  using Bits = typename BitsOf<V>::Type;
  constexpr double kLeastNormal = 2.2250738585072014e-308;
  const V normal = x < kLeastNormal ? x * 18014398509481984.0 : x;  // 2^54
  const V lifted = x < kLeastNormal ? V{} - 54.0 : V{};
  const Bits bits = __builtin_bit_cast(Bits, normal);
  // the mantissa's range then begins at sqrt 1/2 instead of 1
  const Bits from_half = bits + (0x3ff0000000000000 - 0x3fe6a09e667f3bcd);
  const Bits exponent = ((from_half >> 52) & 0xfff) + 0x4330000000000000;  // 2^52 + it, as a double
  const V e = (__builtin_bit_cast(V, exponent) - (4503599627370496.0 + 1023.0)) + lifted;
  const Bits mantissa = (from_half & 0x000fffffffffffff) + 0x3fe6a09e667f3bcd;
  const V f = __builtin_bit_cast(V, mantissa) - 1.0;
  const V s = f / (2.0 + f);
  const V z = s * s;
  const V w = z * z;
  const V even = w * (0.3999999999940942 + w * (0.22222198432149784 + w * 0.15313837699209373));
  const V odd = z * (0.6666666666666735 +
                     w * (0.2857142874366239 + w * (0.1818357216161805 + w * 0.14798198605116586)));
  const V half_f2 = 0.5 * f * f;
  const V y = e * 0.6931471803691238 -
              ((half_f2 - (s * (half_f2 + (even + odd)) + e * 1.9082149292705877e-10)) - f);
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const V at_zero = x < 0.0 ? V{} + std::numeric_limits<double>::quiet_NaN() : V{} - kInfinite;
  const V finite = x <= 0.0 ? at_zero : y;
  return x < kInfinite ? finite : x;  // NaN passes as well
}

/// Valid for |x| <= kSinReach.
inline constexpr double kSinReach = 1e6;
template <class V>
inline V sin(V x) {
  using Bits = typename BitsOf<V>::Type;
  const V turns = x * 0.3183098861837907 + kRounder;
  const V n = turns - kRounder;
  const V r =
      ((x - n * 3.1415926534682512) - n * 1.2154201012607932e-10) - n * 4.044532497591901e-21;
  const V z = r * r;
  const V z2 = z * z;
  const V z4 = z2 * z2;
  const V q = ((-0.16666666666666666 + z * 0.008333333333333333) +
               z2 * (-0.0001984126984126969 + z * 2.755731922394416e-06)) +
              z4 * (((-2.505210837895969e-08 + z * 1.605904322867282e-10) +
                     z2 * (-7.647128570709942e-13 + z * 2.8102313870962216e-15)) +
                    z4 * -7.98395721563106e-18);
  const V y = r + r * (z * q);
  // an odd number of half turns changes the sign
  const Bits odd = __builtin_bit_cast(Bits, turns) << 63;
  return __builtin_bit_cast(V, __builtin_bit_cast(Bits, y) ^ odd);
}

}  // namespace plant_sim::elementary
