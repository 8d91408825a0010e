// Eight doubles that go through the same operations side by side: eight parameter sets on one
// input. Held in as many machine words as the instruction set needs (lane_word.h).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "plant_sim/elementary.h"
#include "plant_sim/lane_word.h"

namespace plant_sim {

template <std::size_t kWidth>
struct LaneMask {
  typename LaneWord<kWidth>::Mask part[8 / kWidth];
};

template <std::size_t kWidth>
class BasicLanes {
  using Word = LaneWord<kWidth>;
  using Vector = typename Word::Vector;

 public:
  static constexpr std::size_t kSize = 8;

  using Mask = LaneMask<kWidth>;

  BasicLanes() : BasicLanes(0.0) {}
  BasicLanes(double all) {  // NOLINT(google-explicit-constructor): constants mix with lanes
    parts_ = written_out<Parts<Vector>>([&](std::size_t) { return Word::every(all); });
  }

  /// From and to kSize doubles in a row.
  static BasicLanes load(const double* from) {
    BasicLanes lanes;
    std::memcpy(&lanes.parts_, from, sizeof(lanes.parts_));
    return lanes;
  }
  void store(double* to) const { std::memcpy(to, &parts_, sizeof(parts_)); }

  [[nodiscard]] double operator[](std::size_t i) const {
    return parts_.part[i / kWidth][i % kWidth];
  }
  void set(std::size_t i, double value) { parts_.part[i / kWidth][i % kWidth] = value; }

  friend BasicLanes operator+(const BasicLanes& a, const BasicLanes& b) {
    return each([&](std::size_t i) { return a.parts_.part[i] + b.parts_.part[i]; });
  }
  friend BasicLanes operator-(const BasicLanes& a, const BasicLanes& b) {
    return each([&](std::size_t i) { return a.parts_.part[i] - b.parts_.part[i]; });
  }
  friend BasicLanes operator*(const BasicLanes& a, const BasicLanes& b) {
    return each([&](std::size_t i) { return a.parts_.part[i] * b.parts_.part[i]; });
  }
  friend BasicLanes operator/(const BasicLanes& a, const BasicLanes& b) {
    return each([&](std::size_t i) { return a.parts_.part[i] / b.parts_.part[i]; });
  }
  friend BasicLanes operator-(const BasicLanes& a) {
    return each([&](std::size_t i) { return -a.parts_.part[i]; });
  }
  BasicLanes& operator+=(const BasicLanes& b) { return *this = *this + b; }
  BasicLanes& operator-=(const BasicLanes& b) { return *this = *this - b; }

  friend Mask operator<(const BasicLanes& a, const BasicLanes& b) {
    return each_mask([&](std::size_t i) { return Word::less(a.parts_.part[i], b.parts_.part[i]); });
  }
  friend Mask operator<=(const BasicLanes& a, const BasicLanes& b) {
    return each_mask(
        [&](std::size_t i) { return Word::at_most(a.parts_.part[i], b.parts_.part[i]); });
  }
  friend Mask operator>(const BasicLanes& a, const BasicLanes& b) { return b < a; }
  friend Mask operator>=(const BasicLanes& a, const BasicLanes& b) { return b <= a; }
  /// Of each word, by its number.
  [[nodiscard]] Vector part(std::size_t i) const { return parts_.part[i]; }
  template <class F>
  [[gnu::always_inline]] static BasicLanes each(F f) {
    return BasicLanes(written_out<Parts<Vector>>(f));
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

  explicit BasicLanes(const Parts<Vector>& parts) : parts_(parts) {}

  /// f of each word's number, without a loop: GCC would keep it, and all words in memory.
  template <class To, class F>
  [[gnu::always_inline]] static To written_out(const F& f) {
    if constexpr (kParts == 1) return {{f(0)}};
    if constexpr (kParts == 2) return {{f(0), f(1)}};
    if constexpr (kParts == 4) return {{f(0), f(1), f(2), f(3)}};
  }

  Parts<Vector> parts_;
};

template <std::size_t W>
LaneMask<W> both(const LaneMask<W>& a, const LaneMask<W>& b) {
  return BasicLanes<W>::each_mask(
      [&](std::size_t i) { return LaneWord<W>::both(a.part[i], b.part[i]); });
}
template <std::size_t W>
bool all(const LaneMask<W>& mask) {
  typename LaneWord<W>::Mask every = mask.part[0];
  for (std::size_t i = 1; i < BasicLanes<W>::kSize / W; ++i) {
    every = LaneWord<W>::both(every, mask.part[i]);
  }
  return LaneWord<W>::all(every);
}
template <std::size_t W>
BasicLanes<W> select(const LaneMask<W>& mask, const BasicLanes<W>& yes, const BasicLanes<W>& no) {
  return BasicLanes<W>::each(
      [&](std::size_t i) { return LaneWord<W>::select(mask.part[i], yes.part(i), no.part(i)); });
}
template <std::size_t W>
BasicLanes<W> min(const BasicLanes<W>& a, const BasicLanes<W>& b) {
  return BasicLanes<W>::each([&](std::size_t i) { return LaneWord<W>::min(a.part(i), b.part(i)); });
}
template <std::size_t W>
BasicLanes<W> max(const BasicLanes<W>& a, const BasicLanes<W>& b) {
  return BasicLanes<W>::each([&](std::size_t i) { return LaneWord<W>::max(a.part(i), b.part(i)); });
}
template <std::size_t W>
BasicLanes<W> abs(const BasicLanes<W>& a) {
  return BasicLanes<W>::each([&](std::size_t i) {
    using Bits = typename LaneWord<W>::Bits;
    return typename LaneWord<W>::Vector(Bits(a.part(i)) & INT64_MAX);
  });
}
template <std::size_t W>
BasicLanes<W> sqrt(const BasicLanes<W>& a) {
  return BasicLanes<W>::each([&](std::size_t i) { return LaneWord<W>::sqrt(a.part(i)); });
}
template <std::size_t W>
BasicLanes<W> floor(const BasicLanes<W>& a) {
  return BasicLanes<W>::each([&](std::size_t i) { return LaneWord<W>::floor(a.part(i)); });
}
template <std::size_t W>
BasicLanes<W> ceil(const BasicLanes<W>& a) {
  return BasicLanes<W>::each([&](std::size_t i) { return LaneWord<W>::ceil(a.part(i)); });
}
template <std::size_t W>
BasicLanes<W> exp(const BasicLanes<W>& a) {
  return BasicLanes<W>::each([&](std::size_t i) { return elementary::exp(a.part(i)); });
}
template <std::size_t W>
BasicLanes<W> decay(const BasicLanes<W>& a) {
  return BasicLanes<W>::each([&](std::size_t i) { return elementary::decay(a.part(i)); });
}
template <std::size_t W>
BasicLanes<W> log(const BasicLanes<W>& a) {
  return BasicLanes<W>::each([&](std::size_t i) { return elementary::log(a.part(i)); });
}
/// f of each lane's value.
template <std::size_t W, class F>
BasicLanes<W> one_by_one(const BasicLanes<W>& a, F&& f) {
  BasicLanes<W> result;
  for (std::size_t i = 0; i < BasicLanes<W>::kSize; ++i) result.set(i, f(a[i]));
  return result;
}
template <std::size_t W>
BasicLanes<W> sin(const BasicLanes<W>& a) {
  const auto near = BasicLanes<W>::each([&](std::size_t i) { return elementary::sin(a.part(i)); });
  const auto in_reach = abs(a) <= BasicLanes<W>(elementary::kSinReach);
  if (all(in_reach)) return near;
  return select(in_reach, near, one_by_one(a, ::sin));
}
/// The largest value of any lane.
template <std::size_t W>
double widest(const BasicLanes<W>& a) {
  double most = a[0];
  for (std::size_t i = 1; i < BasicLanes<W>::kSize; ++i) most = most > a[i] ? most : a[i];
  return most;
}
/// at(index), where at gives lanes for a whole index; each lane has its own index.
template <std::size_t W, class At>
BasicLanes<W> pick(const BasicLanes<W>& index, At&& at) {
  BasicLanes<W> picked;
  for (std::size_t i = 0; i < BasicLanes<W>::kSize; ++i) {
    picked.set(i, at(static_cast<std::size_t>(index[i]))[i]);
  }
  return picked;
}

/// What every machine can do.
using Lanes = BasicLanes<2>;

}  // namespace plant_sim
