// The formula effects of a plant: parameter values, which of them are active, and what they
// contribute at each site. As with the effects of the table, one whose parameters are all neutral
// is skipped. Results that are not finite count as no contribution.
#pragma once

#include <cstring>
#include <vector>

#include "plant_sim/formula/formula.h"
#include "plant_sim/formula/max_slope.h"

namespace plant_sim::formula {

template <class S>
class FormulaSet {
 public:
  FormulaSet() = default;

  /// Replaces the declared formulas; all values are neutral. The viewed data must outlive *this.
  void declare(const FormulaView* formulas, std::size_t count) {
    effects_.clear();
    effects_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) effects_.emplace_back(formulas[i]);
    fresh_ = true;
  }

  /// Calls f(const FormulaView&, const ParameterInfo&, S& value) for each parameter of each
  /// formula. The values live until the next declare().
  template <class F>
  void each(F&& f) {
    for (Effect& effect : effects_) {
      for (std::size_t i = 0; i < effect.values.size(); ++i) {
        f(effect.formula, effect.formula.parameters[i], effect.values[i]);
      }
    }
  }

  /// True when the values equal those of the last prepare(), bit for bit.
  [[nodiscard]] bool unchanged() const {
    for (const Effect& effect : effects_) {
      if (!effect.unchanged()) return false;
    }
    return !fresh_;
  }

  /// Brings parameters into their ranges and finds out which formulas are active, all when
  /// `always`. No allocation.
  void prepare(bool always) {
    sites_ = 0;
    for (Effect& effect : effects_) {
      if (!fresh_ && effect.unchanged() && always == always_) {
        if (effect.active) sites_ |= bit(effect.formula.site);
        continue;
      }
      bool neutral = true;
      for (std::size_t i = 0; i < effect.values.size(); ++i) {
        const ParameterInfo& info = effect.formula.parameters[i];
        S& value = effect.values[i];
        value = clamp(value, S(info.min), S(info.max));
        neutral = neutral && all((value <= S(info.neutral)) & (value >= S(info.neutral)));
        effect.prepared[i] = value;
      }
      effect.active = !neutral || always;
      if (!effect.active) continue;
      sites_ |= bit(effect.formula.site);
      effect.run.set_parameters(effect.values.data());
      if (effect.formula.site == effects::Site::force) {
        effect.max_slope.prepare(
            effect.formula.ranges[0], effect.formula.ranges[1],
            [&](const S& y_m, const S& v_mps) { return effect.contribution(y_m, v_mps); });
      }
      if (effect.formula.site == effects::Site::leakage) {
        effect.conductance_m3ps_per_Pa =
            S(2.0) *
            steepest_m3ps_per_Pa<S>(effect.formula.ranges[0], [&](const S& in_Pa, const S& out_Pa) {
              return effect.contribution(in_Pa, out_Pa);
            });
      }
    }
    fresh_ = false;
    always_ = always;
  }

  /// A bit per site, as the store of effects counts them.
  [[nodiscard]] unsigned sites() const { return sites_; }
  [[nodiscard]] bool acts_on(effects::Site site) const { return (sites_ & bit(site)) != 0; }

  /// Chained sites: applies the formulas to x one after the other.
  [[nodiscard]] S chain(effects::Site site, S x, const S& second) const {
    each_active(site, [&](const Effect& effect) { x = effect.result(x, second, x); });
    return x;
  }

  /// Force and leakage: sum of the formulas.
  [[nodiscard]] S sum(effects::Site site, const S& first, const S& second) const {
    S total = 0.0;
    each_active(site, [&](const Effect& effect) { total += effect.contribution(first, second); });
    return total;
  }

  /// The largest |dF/dv| at any speed up to |v_mps|, estimated.
  [[nodiscard]] S slope_N_s_per_m(const S& v_mps) const {
    S total = 0.0;
    each_active(effects::Site::force,
                [&](const Effect& effect) { total += effect.max_slope.slope_N_s_per_m(v_mps); });
    return total;
  }

  /// The largest |dF/dy| over the plausible positions and speeds, estimated.
  [[nodiscard]] S stiffness_N_per_m() const {
    S total = 0.0;
    each_active(effects::Site::force,
                [&](const Effect& effect) { total += effect.max_slope.stiffness_N_per_m(); });
    return total;
  }
  /// The same at any speed up to |v_mps|.
  [[nodiscard]] S stiffness_N_per_m(const S& v_mps) const {
    S total = 0.0;
    each_active(effects::Site::force,
                [&](const Effect& effect) { total += effect.max_slope.stiffness_N_per_m(v_mps); });
    return total;
  }

  /// Twice the largest |dQ/dp| over the plausible pressures, estimated: both chambers see it.
  [[nodiscard]] S conductance_m3ps_per_Pa() const {
    S total = 0.0;
    each_active(effects::Site::leakage,
                [&](const Effect& effect) { total += effect.conductance_m3ps_per_Pa; });
    return total;
  }

 private:
  struct Effect {
    explicit Effect(const FormulaView& declared) : formula(declared), run(declared.program) {
      values.reserve(declared.program.parameters);
      for (std::size_t i = 0; i < declared.program.parameters; ++i) {
        values.emplace_back(declared.parameters[i].neutral);
      }
      prepared = values;
    }

    /// True when the values equal those of the last prepare(), bit for bit.
    [[nodiscard]] bool unchanged() const {
      return std::memcmp(static_cast<const void*>(values.data()),
                         static_cast<const void*>(prepared.data()), values.size() * sizeof(S)) == 0;
    }

    /// The formula's value within the guard; `none` where it is not finite.
    [[nodiscard]] S result(const S& first, const S& second, const S& none) const {
      constexpr double kFinite = 1e300;
      const S value = run(first, second);
      const S guard = formula.guard;
      return select(abs(value) <= S(kFinite), clamp(value, -guard, guard), none);
    }
    [[nodiscard]] S contribution(const S& first, const S& second) const {
      return result(first, second, S(0.0));
    }

    FormulaView formula;
    ExpressionEvaluator<S> run;
    std::vector<S> values;
    std::vector<S> prepared;  ///< state of the last prepare()
    MaxSlope<S> max_slope;
    S conductance_m3ps_per_Pa = 0.0;
    bool active = false;
  };

  static constexpr unsigned bit(effects::Site site) { return 1U << static_cast<unsigned>(site); }

  template <class F>
  void each_active(effects::Site site, F&& f) const {
    for (const Effect& effect : effects_) {
      if (effect.active && effect.formula.site == site) f(effect);
    }
  }

  std::vector<Effect> effects_;
  unsigned sites_ = 0;
  bool fresh_ = false;
  bool always_ = false;  ///< as the last prepare() was called
};

}  // namespace plant_sim::formula
