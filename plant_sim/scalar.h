// The two kinds of number that the physics is written for: double, and Lanes, eight doubles that go
// through the same operations side by side (eight parameter sets on one input).
//
// Code templated on Scalar uses + - * / and the functions below, never a branch on a value:
// select() takes both sides. Each lane does exactly the operations of the double version.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace plant_sim {

// ---- double ----
inline double select(bool mask, double yes, double no) { return mask ? yes : no; }
inline double min(double a, double b) { return a < b ? a : b; }
inline double max(double a, double b) { return a > b ? a : b; }
inline double sqrt(double a) { return std::sqrt(a); }
inline double exp(double a) { return std::exp(a); }
inline double log(double a) { return std::log(a); }
inline double sin(double a) { return std::sin(a); }
inline double ceil(double a) { return std::ceil(a); }
inline double floor(double a) { return std::floor(a); }
inline double abs(double a) { return std::fabs(a); }
inline bool all(bool mask) { return mask; }
inline bool both(bool a, bool b) { return a && b; }
/// The largest value of any lane.
inline double widest(double a) { return a; }
/// at(index), where at gives a number for a whole index; of lanes, each with its own index.
template <class At>
double pick(double index, At&& at) {
  return at(static_cast<std::size_t>(index));
}

// ---- eight lanes ----
// Four pairs, the width that every x86-64 and aarch64 has; a wider machine word changes only Pair.
class Lanes {
 public:
  static constexpr std::size_t kSize = 8;
  using Pair = double __attribute__((vector_size(16)));
  using PairMask = std::int64_t __attribute__((vector_size(16)));

  struct Mask {
    std::array<PairMask, 4> part;
  };

  Lanes() : Lanes(0.0) {}
  Lanes(double all) {  // NOLINT(google-explicit-constructor): constants mix with lanes
    for (Pair& p : part_) p = Pair{all, all};
  }

  [[nodiscard]] double operator[](std::size_t i) const { return part_[i / 2][i % 2]; }
  void set(std::size_t i, double value) { part_[i / 2][i % 2] = value; }

  template <class F>
  static Lanes each(F f) {
    return Lanes({f(0), f(1), f(2), f(3)});
  }
  template <class F>
  static Mask each_mask(F f) {
    return {{f(0), f(1), f(2), f(3)}};
  }
  [[nodiscard]] Pair part(std::size_t i) const { return part_[i]; }

  friend Lanes operator+(const Lanes& a, const Lanes& b) {
    return each([&](std::size_t i) { return a.part_[i] + b.part_[i]; });
  }
  friend Lanes operator-(const Lanes& a, const Lanes& b) {
    return each([&](std::size_t i) { return a.part_[i] - b.part_[i]; });
  }
  friend Lanes operator*(const Lanes& a, const Lanes& b) {
    return each([&](std::size_t i) { return a.part_[i] * b.part_[i]; });
  }
  friend Lanes operator/(const Lanes& a, const Lanes& b) {
    return each([&](std::size_t i) { return a.part_[i] / b.part_[i]; });
  }
  friend Lanes operator-(const Lanes& a) {
    return each([&](std::size_t i) { return -a.part_[i]; });
  }
  Lanes& operator+=(const Lanes& b) { return *this = *this + b; }
  Lanes& operator-=(const Lanes& b) { return *this = *this - b; }

  friend Mask operator<(const Lanes& a, const Lanes& b) {
    return each_mask([&](std::size_t i) { return PairMask(a.part_[i] < b.part_[i]); });
  }
  friend Mask operator<=(const Lanes& a, const Lanes& b) {
    return each_mask([&](std::size_t i) { return PairMask(a.part_[i] <= b.part_[i]); });
  }
  friend Mask operator>(const Lanes& a, const Lanes& b) { return b < a; }
  friend Mask operator>=(const Lanes& a, const Lanes& b) { return b <= a; }

 private:
  explicit Lanes(const std::array<Pair, 4>& part) : part_(part) {}
  std::array<Pair, 4> part_;
};

inline Lanes select(const Lanes::Mask& mask, const Lanes& yes, const Lanes& no) {
  return Lanes::each(
      [&](std::size_t i) -> Lanes::Pair { return mask.part[i] ? yes.part(i) : no.part(i); });
}
inline Lanes min(const Lanes& a, const Lanes& b) { return select(a < b, a, b); }
inline Lanes max(const Lanes& a, const Lanes& b) { return select(a > b, a, b); }
inline Lanes abs(const Lanes& a) {
  return Lanes::each([&](std::size_t i) -> Lanes::Pair {
    const Lanes::PairMask magnitude = {INT64_MAX, INT64_MAX};
    return Lanes::Pair(Lanes::PairMask(a.part(i)) & magnitude);
  });
}
inline Lanes sqrt(const Lanes& a) {
  return Lanes::each([&](std::size_t i) -> Lanes::Pair {
#ifdef __SSE2__
    return _mm_sqrt_pd(a.part(i));
#else
    return Lanes::Pair{std::sqrt(a.part(i)[0]), std::sqrt(a.part(i)[1])};
#endif
  });
}
template <double (*F)(double)>
Lanes one_by_one(const Lanes& a) {
  return Lanes::each([&](std::size_t i) -> Lanes::Pair {
    return Lanes::Pair{F(a.part(i)[0]), F(a.part(i)[1])};
  });
}
inline Lanes exp(const Lanes& a) { return one_by_one<exp>(a); }
inline Lanes log(const Lanes& a) { return one_by_one<log>(a); }
inline Lanes sin(const Lanes& a) { return one_by_one<sin>(a); }
inline Lanes ceil(const Lanes& a) { return one_by_one<ceil>(a); }
inline Lanes floor(const Lanes& a) { return one_by_one<floor>(a); }
template <class At>
Lanes pick(const Lanes& index, At&& at) {
  Lanes picked;
  for (std::size_t i = 0; i < Lanes::kSize; ++i) {
    picked.set(i, at(static_cast<std::size_t>(index[i]))[i]);
  }
  return picked;
}
inline bool all(const Lanes::Mask& mask) {
  const Lanes::PairMask m = mask.part[0] & mask.part[1] & mask.part[2] & mask.part[3];
  return (m[0] & m[1]) != 0;
}
inline Lanes::Mask both(const Lanes::Mask& a, const Lanes::Mask& b) {
  return Lanes::each_mask([&](std::size_t i) { return a.part[i] & b.part[i]; });
}
inline double widest(const Lanes& a) {
  double most = a[0];
  for (std::size_t i = 1; i < Lanes::kSize; ++i) most = max(most, a[i]);
  return most;
}

// ---- either ----
/// Within lo..hi; what is not a number becomes lo.
template <class Scalar>
Scalar clamp(const Scalar& a, const Scalar& lo, const Scalar& hi) {
  return min(max(a, lo), hi);
}

}  // namespace plant_sim
