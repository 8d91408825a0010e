// Vector of eight doubles: eight parameter sets simulated on one input. Held in as many registers
// as the instruction set needs (simd_register.h). Not a general SIMD library such as xsimd, because
// each lane must give the bits of the scalar code, exp, log, sin and tanh included.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "plant_sim/elementary.h"
#include "plant_sim/simd_register.h"

namespace plant_sim {

template <std::size_t kWidth>
struct SimdMask {
  typename SimdRegister<kWidth>::Mask part[8 / kWidth];
};

template <std::size_t kWidth>
class SimdVector {
  using Word = SimdRegister<kWidth>;
  using Vector = typename Word::Vector;

 public:
  static constexpr std::size_t kSize = 8;

  using Mask = SimdMask<kWidth>;

  SimdVector() : SimdVector(0.0) {}
  SimdVector(double all) {  // NOLINT(google-explicit-constructor): constants mix with lanes
    parts_ = written_out<Parts<Vector>>([&](std::size_t) { return Word::every(all); });
  }

  /// Loads and stores kSize consecutive doubles.
  static SimdVector load(const double* from) {
    SimdVector lanes;
    std::memcpy(&lanes.parts_, from, sizeof(lanes.parts_));
    return lanes;
  }
  void store(double* to) const { std::memcpy(to, &parts_, sizeof(parts_)); }

  [[nodiscard]] double operator[](std::size_t i) const {
    return parts_.part[i / kWidth][i % kWidth];
  }
  void set(std::size_t i, double value) { parts_.part[i / kWidth][i % kWidth] = value; }

  friend SimdVector operator+(const SimdVector& a, const SimdVector& b) {
    return each([&](std::size_t i) { return a.parts_.part[i] + b.parts_.part[i]; });
  }
  friend SimdVector operator-(const SimdVector& a, const SimdVector& b) {
    return each([&](std::size_t i) { return a.parts_.part[i] - b.parts_.part[i]; });
  }
  friend SimdVector operator*(const SimdVector& a, const SimdVector& b) {
    return each([&](std::size_t i) { return a.parts_.part[i] * b.parts_.part[i]; });
  }
  friend SimdVector operator/(const SimdVector& a, const SimdVector& b) {
    return each([&](std::size_t i) { return a.parts_.part[i] / b.parts_.part[i]; });
  }
  friend SimdVector operator-(const SimdVector& a) {
    return each([&](std::size_t i) { return -a.parts_.part[i]; });
  }
  SimdVector& operator+=(const SimdVector& b) { return *this = *this + b; }
  SimdVector& operator-=(const SimdVector& b) { return *this = *this - b; }

  friend Mask operator<(const SimdVector& a, const SimdVector& b) {
    return each_mask([&](std::size_t i) { return Word::less(a.parts_.part[i], b.parts_.part[i]); });
  }
  friend Mask operator<=(const SimdVector& a, const SimdVector& b) {
    return each_mask(
        [&](std::size_t i) { return Word::at_most(a.parts_.part[i], b.parts_.part[i]); });
  }
  friend Mask operator>(const SimdVector& a, const SimdVector& b) { return b < a; }
  friend Mask operator>=(const SimdVector& a, const SimdVector& b) { return b <= a; }
  /// Register `i`.
  [[nodiscard]] Vector part(std::size_t i) const { return parts_.part[i]; }
  template <class F>
  [[gnu::always_inline]] static SimdVector each(F f) {
    return SimdVector(written_out<Parts<Vector>>(f));
  }
  template <class F>
  [[gnu::always_inline]] static Mask each_mask(F f) {
    return written_out<Mask>(f);
  }

 private:
  static constexpr std::size_t kParts = kSize / kWidth;
  template <class T>
  struct Parts {
    T part[kParts];
  };

  explicit SimdVector(const Parts<Vector>& parts) : parts_(parts) {}

  /// f(i) of each register, unrolled by hand: GCC would keep the loop and all registers in memory.
  template <class To, class F>
  [[gnu::always_inline]] static To written_out(const F& f) {
    if constexpr (kParts == 1) return {{f(0)}};
    if constexpr (kParts == 2) return {{f(0), f(1)}};
    if constexpr (kParts == 4) return {{f(0), f(1), f(2), f(3)}};
  }

  Parts<Vector> parts_;
};

template <std::size_t W>
SimdMask<W> operator&(const SimdMask<W>& a, const SimdMask<W>& b) {
  return SimdVector<W>::each_mask(
      [&](std::size_t i) { return SimdRegister<W>::bit_and(a.part[i], b.part[i]); });
}
template <std::size_t W>
bool all(const SimdMask<W>& mask) {
  typename SimdRegister<W>::Mask every = mask.part[0];
  for (std::size_t i = 1; i < SimdVector<W>::kSize / W; ++i) {
    every = SimdRegister<W>::bit_and(every, mask.part[i]);
  }
  return SimdRegister<W>::all(every);
}
template <std::size_t W>
SimdVector<W> select(const SimdMask<W>& mask, const SimdVector<W>& yes, const SimdVector<W>& no) {
  return SimdVector<W>::each([&](std::size_t i) {
    return SimdRegister<W>::select(mask.part[i], yes.part(i), no.part(i));
  });
}
template <std::size_t W>
SimdVector<W> min(const SimdVector<W>& a, const SimdVector<W>& b) {
  return SimdVector<W>::each(
      [&](std::size_t i) { return SimdRegister<W>::min(a.part(i), b.part(i)); });
}
template <std::size_t W>
SimdVector<W> max(const SimdVector<W>& a, const SimdVector<W>& b) {
  return SimdVector<W>::each(
      [&](std::size_t i) { return SimdRegister<W>::max(a.part(i), b.part(i)); });
}
template <std::size_t W>
SimdVector<W> abs(const SimdVector<W>& a) {
  return SimdVector<W>::each([&](std::size_t i) {
    using Bits = typename SimdRegister<W>::Bits;
    return typename SimdRegister<W>::Vector(Bits(a.part(i)) & INT64_MAX);
  });
}
template <std::size_t W>
SimdVector<W> sqrt(const SimdVector<W>& a) {
  return SimdVector<W>::each([&](std::size_t i) { return SimdRegister<W>::sqrt(a.part(i)); });
}
template <std::size_t W>
SimdVector<W> floor(const SimdVector<W>& a) {
  return SimdVector<W>::each([&](std::size_t i) { return SimdRegister<W>::floor(a.part(i)); });
}
template <std::size_t W>
SimdVector<W> ceil(const SimdVector<W>& a) {
  return SimdVector<W>::each([&](std::size_t i) { return SimdRegister<W>::ceil(a.part(i)); });
}
template <std::size_t W>
SimdVector<W> exp(const SimdVector<W>& a) {
  return SimdVector<W>::each([&](std::size_t i) { return elementary::exp(a.part(i)); });
}
template <std::size_t W>
SimdVector<W> decay(const SimdVector<W>& a) {
  return SimdVector<W>::each([&](std::size_t i) { return elementary::decay(a.part(i)); });
}
template <std::size_t W>
SimdVector<W> log(const SimdVector<W>& a) {
  return SimdVector<W>::each([&](std::size_t i) { return elementary::log(a.part(i)); });
}
template <std::size_t W>
SimdVector<W> tanh(const SimdVector<W>& a) {
  return SimdVector<W>::each([&](std::size_t i) { return elementary::tanh(a.part(i)); });
}
/// f applied to each lane.
template <std::size_t W, class F>
SimdVector<W> one_by_one(const SimdVector<W>& a, F&& f) {
  SimdVector<W> result;
  for (std::size_t i = 0; i < SimdVector<W>::kSize; ++i) result.set(i, f(a[i]));
  return result;
}
template <std::size_t W>
SimdVector<W> sin(const SimdVector<W>& a) {
  const auto near = SimdVector<W>::each([&](std::size_t i) { return elementary::sin(a.part(i)); });
  const auto in_reach = abs(a) <= SimdVector<W>(elementary::kSinReach);
  if (all(in_reach)) return near;
  return select(in_reach, near, one_by_one(a, ::sin));
}
/// Largest lane.
template <std::size_t W>
double reduce_max(const SimdVector<W>& a) {
  double most = a[0];
  for (std::size_t i = 1; i < SimdVector<W>::kSize; ++i) most = most > a[i] ? most : a[i];
  return most;
}
/// at(index), where `at` returns lanes for an integer index; each lane has its own index.
template <std::size_t W, class At>
SimdVector<W> pick(const SimdVector<W>& index, At&& at) {
  SimdVector<W> picked;
  for (std::size_t i = 0; i < SimdVector<W>::kSize; ++i) {
    picked.set(i, at(static_cast<std::size_t>(index[i]))[i]);
  }
  return picked;
}

/// The width that every machine supports.
using Simd = SimdVector<2>;

}  // namespace plant_sim
