// Parameters, memory and activity of a plant's effects. An effect whose parameters are all neutral
// is skipped.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <tuple>
#include <utility>

#include "plant_sim/effects/site.h"
#include "plant_sim/formula/formula_set.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S, template <class> class... E>
class EffectStore {
 public:
  static constexpr std::size_t kCount = sizeof...(E);

  /// Calls f(effect type tag, parameters) for each effect in the order of the table.
  template <class F>
  void each(F&& f) {
    each_index([&](auto i) { f(Tag<Effect<i>>{}, std::get<i>(parameters_)); });
  }

  /// Calls f(effect type tag, memory) for each effect in the order of the table.
  template <class F>
  void each_memory(F&& f) {
    each_index([&](auto i) { f(Tag<Effect<i>>{}, std::get<i>(memory_)); });
  }

  /// Call after a change of parameters: clamps them to their ranges and determines the active
  /// effects. Allocates only at the first call and when the step changes.
  void prepare(double step_s) {
    if (step_s == step_s_ && unchanged() && formulas_.unchanged()) return;
    formulas_.prepare(always_);
    used_sites_ = formulas_.sites();
    each_index([&](auto i) {
      bool neutral = true;
      std::get<i>(parameters_).visit([&](const ParameterInfo& info, S& value) {
        value = clamp(value, S(info.min), S(info.max));
        neutral = neutral && all((value <= S(info.neutral)) & (value >= S(info.neutral)));
      });
      active_[i] = !neutral || always_;
      for (const Site site : Effect<i>::kSites) used_sites_ |= active_[i] ? bit(site) : 0U;
      auto& memory = std::get<i>(memory_);
      if constexpr (requires { memory.prepare(step_s); }) memory.prepare(step_s);
    });
    prepared_ = parameters_;
    step_s_ = step_s;
  }

  /// The formulas of the model file; declare them before the first prepare().
  [[nodiscard]] formula::FormulaSet<S>& formulas() { return formulas_; }

  /// For tests: evaluates neutral effects too.
  void set_always(bool always) {
    always_ = always;
    step_s_ = 0.0;
  }

  void reset() {
    each_index([&](auto i) {
      auto& memory = std::get<i>(memory_);
      if constexpr (requires { memory.reset(); }) {
        memory.reset();
      } else {
        memory = {};
      }
    });
  }

  /// True when any effect is active.
  [[nodiscard]] bool any() const { return used_sites_ != 0; }
  /// True when an active effect acts at the site.
  [[nodiscard]] bool acts_on(Site site) const { return (used_sites_ & bit(site)) != 0; }

 protected:
  formula::FormulaSet<S> formulas_;

  template <class T>
  struct Tag {
    using Type = T;
  };

  /// Calls f(tag, parameters, memory) for each active effect of the site.
  template <Site kSite, class F>
  void for_each_active(F&& f) const {
    if ((used_sites_ & bit(kSite)) == 0) return;
    each_index([&](auto i) {
      if constexpr (has_site(Effect<i>::kSites, kSite)) {
        if (active_[i]) f(Tag<Effect<i>>{}, std::get<i>(parameters_), std::get<i>(memory_));
      }
    });
  }
  template <Site kSite, class F>
  void for_each_active(F&& f) {
    if ((used_sites_ & bit(kSite)) == 0) return;
    each_index([&](auto i) {
      if constexpr (has_site(Effect<i>::kSites, kSite)) {
        if (active_[i]) f(Tag<Effect<i>>{}, std::get<i>(parameters_), std::get<i>(memory_));
      }
    });
  }
  /// Calls f(tag, parameters, memory) for each active effect of any site.
  template <class F>
  void for_each_active(F&& f) {
    each_index([&](auto i) {
      if (active_[i]) f(Tag<Effect<i>>{}, std::get<i>(parameters_), std::get<i>(memory_));
    });
  }

 private:
  template <std::size_t kIndex>
  using Effect = std::tuple_element_t<kIndex, std::tuple<E<S>...>>;
  using AllParameters = std::tuple<typename E<S>::Parameters...>;

  static constexpr unsigned bit(Site site) { return 1U << static_cast<unsigned>(site); }

  /// Compares bit for bit, so that NaN equals itself.
  [[nodiscard]] bool unchanged() const {
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): numbers only, without padding
    return std::memcmp(&parameters_, &prepared_, sizeof(AllParameters)) == 0;
  }

  template <class F>
  static void each_index(F&& f) {
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      (f(std::integral_constant<std::size_t, I>{}), ...);
    }
    (std::make_index_sequence<kCount>{});
  }

  AllParameters parameters_;
  AllParameters prepared_;  ///< state of the last prepare()
  std::tuple<typename E<S>::Memory...> memory_;
  std::array<bool, kCount> active_{};
  unsigned used_sites_ = 0;
  double step_s_ = 0.0;
  bool always_ = false;
};

}  // namespace plant_sim::effects
