// One SIMD register and its operations: two doubles (SSE2, or any machine by GCC's vector
// extension), four (AVX2) or eight (AVX-512). Every operation gives in each lane the bits that the
// double version in scalar.h gives.
//
// Words wider than two exist only where the file is compiled for them. Everything built on a word
// carries its width in its type, so that no function compiled for a wide machine can be taken by
// the linker for the one that runs on every machine.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#if defined(__AVX2__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace plant_sim {

template <std::size_t kWidth>
struct SimdRegister;

template <>
struct SimdRegister<2> {
  using Vector = double __attribute__((vector_size(16)));
  using Bits = std::int64_t __attribute__((vector_size(16)));
  using Mask = Bits;

  static Vector every(double a) { return Vector{a, a}; }
  static Mask less(Vector a, Vector b) { return a < b; }
  static Mask at_most(Vector a, Vector b) { return a <= b; }
  static Mask bit_and(Mask a, Mask b) { return a & b; }
  static bool all(Mask m) { return (m[0] & m[1]) != 0; }
  static Vector select(Mask m, Vector yes, Vector no) { return m ? yes : no; }
#ifdef __SSE2__
  static Vector min(Vector a, Vector b) { return _mm_min_pd(a, b); }
  static Vector max(Vector a, Vector b) { return _mm_max_pd(a, b); }
  static Vector sqrt(Vector a) { return _mm_sqrt_pd(a); }
#else
  static Vector min(Vector a, Vector b) { return a < b ? a : b; }
  static Vector max(Vector a, Vector b) { return a > b ? a : b; }
  static Vector sqrt(Vector a) { return Vector{std::sqrt(a[0]), std::sqrt(a[1])}; }
#endif
  static Vector floor(Vector a) { return Vector{std::floor(a[0]), std::floor(a[1])}; }
  static Vector ceil(Vector a) { return Vector{std::ceil(a[0]), std::ceil(a[1])}; }
};

#ifdef __AVX2__
template <>
struct SimdRegister<4> {
  using Vector = double __attribute__((vector_size(32)));
  using Bits = std::int64_t __attribute__((vector_size(32)));
  using Mask = Vector;

  static Vector every(double a) { return _mm256_set1_pd(a); }
  static Mask less(Vector a, Vector b) { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
  static Mask at_most(Vector a, Vector b) { return _mm256_cmp_pd(a, b, _CMP_LE_OQ); }
  static Mask bit_and(Mask a, Mask b) { return _mm256_and_pd(a, b); }
  static bool all(Mask m) { return _mm256_movemask_pd(m) == 0xf; }
  static Vector select(Mask m, Vector yes, Vector no) { return _mm256_blendv_pd(no, yes, m); }
  static Vector min(Vector a, Vector b) { return _mm256_min_pd(a, b); }
  static Vector max(Vector a, Vector b) { return _mm256_max_pd(a, b); }
  static Vector sqrt(Vector a) { return _mm256_sqrt_pd(a); }
  static Vector floor(Vector a) { return _mm256_floor_pd(a); }
  static Vector ceil(Vector a) { return _mm256_ceil_pd(a); }
};
#endif

#ifdef __AVX512F__
template <>
struct SimdRegister<8> {
  using Vector = double __attribute__((vector_size(64)));
  using Bits = std::int64_t __attribute__((vector_size(64)));
  using Mask = __mmask8;
  // the forms without a mask make GCC 12 warn of an undefined value
  static constexpr Mask kEvery = 0xff;

  static Vector every(double a) { return _mm512_set1_pd(a); }
  static Mask less(Vector a, Vector b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
  static Mask at_most(Vector a, Vector b) { return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ); }
  static Mask bit_and(Mask a, Mask b) { return static_cast<Mask>(a & b); }
  static bool all(Mask m) { return m == kEvery; }
  static Vector select(Mask m, Vector yes, Vector no) { return _mm512_mask_blend_pd(m, no, yes); }
  static Vector min(Vector a, Vector b) { return _mm512_maskz_min_pd(kEvery, a, b); }
  static Vector max(Vector a, Vector b) { return _mm512_maskz_max_pd(kEvery, a, b); }
  static Vector sqrt(Vector a) { return _mm512_maskz_sqrt_pd(kEvery, a); }
  static Vector floor(Vector a) {
    return _mm512_maskz_roundscale_pd(kEvery, a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
  }
  static Vector ceil(Vector a) {
    return _mm512_maskz_roundscale_pd(kEvery, a, _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC);
  }
};
#endif

}  // namespace plant_sim
