// All effects of the table in one object: parameters, memory, and per site the sum or the chain of
// what the active ones contribute. An effect with every parameter neutral is skipped.
#pragma once

#include <array>
#include <cstddef>
#include <tuple>
#include <utility>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim {

template <class S, template <class> class... E>
class EffectSet {
 public:
  static constexpr std::size_t kCount = sizeof...(E);

  /// Calls f(effect type tag, parameters) for each effect in the order of the table.
  template <class F>
  void each(F&& f) {
    each_index([&](auto i) { f(std::get<i>(kTypes), std::get<i>(parameters_)); });
  }

  /// To be called after parameters have changed: brings them into their ranges and finds out which
  /// effects are active.
  void prepare() {
    any_ = false;
    each_index([&](auto i) {
      bool neutral = true;
      std::get<i>(parameters_).visit([&](const ParameterInfo& info, S& value) {
        value = clamp(value, S(info.min), S(info.max));
        neutral = neutral && all(both(value <= S(info.neutral), value >= S(info.neutral)));
      });
      active_[i] = !neutral || always_;
      any_ = any_ || active_[i];
    });
  }

  /// For tests: neutral effects take part too.
  void set_always(bool always) { always_ = always; }

  void reset() { memory_ = {}; }

  [[nodiscard]] S opening_m(S x_m, const S& gain_m_per_V) const {
    act([&](auto type, const auto& p, const auto&) {
      using Type = typename decltype(type)::Type;
      if constexpr (requires { Type::opening_m(p, x_m, gain_m_per_V); }) {
        x_m = Type::opening_m(p, x_m, gain_m_per_V);
      }
    });
    return x_m;
  }

  [[nodiscard]] S added_mass_kg() const {
    S sum = 0.0;
    act([&](auto type, const auto& p, const auto&) {
      using Type = typename decltype(type)::Type;
      if constexpr (requires { Type::added_mass_kg(p); }) sum += Type::added_mass_kg(p);
    });
    return sum;
  }

  [[nodiscard]] S resisting_N(const S& y_m, const S& v_mps) const {
    S sum = 0.0;
    act([&](auto type, const auto& p, const auto&) {
      using Type = typename decltype(type)::Type;
      if constexpr (requires { Type::resisting_N(p, y_m, v_mps); }) {
        sum += Type::resisting_N(p, y_m, v_mps);
      }
    });
    return sum;
  }

  [[nodiscard]] S slope_N_s_per_m(const S& v_mps) const {
    S sum = 0.0;
    act([&](auto type, const auto& p, const auto&) {
      using Type = typename decltype(type)::Type;
      if constexpr (requires { Type::slope_N_s_per_m(p, v_mps); }) {
        sum += Type::slope_N_s_per_m(p, v_mps);
      }
    });
    return sum;
  }

  /// at.drive_N without friction; of several frictions each sees what the earlier ones left.
  [[nodiscard]] S friction_N(DryContact<S> at) const {
    S sum = 0.0;
    act([&](auto type, const auto& p, const auto& memory) {
      using Type = typename decltype(type)::Type;
      if constexpr (requires { Type::friction_N(p, memory, at); }) {
        const S one = Type::friction_N(p, memory, at);
        at.drive_N -= one;
        sum += one;
      }
    });
    return sum;
  }

  void accept(const S& travel_m, const S& v_mps) {
    if (!any_) return;
    each_index([&](auto i) {
      using Type = typename std::tuple_element_t<i, Types>::Type;
      if constexpr (requires {
                      Type::accept(std::get<i>(parameters_), std::get<i>(memory_), travel_m, v_mps);
                    }) {
        if (active_[i])
          Type::accept(std::get<i>(parameters_), std::get<i>(memory_), travel_m, v_mps);
      }
    });
  }

 private:
  template <class T>
  struct Tag {
    using Type = T;
  };
  using Types = std::tuple<Tag<E<S>>...>;
  static constexpr Types kTypes{};

  template <class F>
  static void each_index(F&& f) {
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      (f(std::integral_constant<std::size_t, I>{}), ...);
    }
    (std::make_index_sequence<kCount>{});
  }

  template <class F>
  void act(F&& f) const {
    if (!any_) return;
    each_index([&](auto i) {
      if (active_[i]) f(std::get<i>(kTypes), std::get<i>(parameters_), std::get<i>(memory_));
    });
  }

  std::tuple<typename E<S>::Parameters...> parameters_;
  std::tuple<typename E<S>::Memory...> memory_;
  std::array<bool, kCount> active_{};
  bool any_ = false;
  bool always_ = false;
};

}  // namespace plant_sim
