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

  [[nodiscard]] std::size_t size() const { return effects_.size(); }

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
        if (effect.active) sites_ |= bit(effect.site());
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
      sites_ |= bit(effect.site());
      effect.set_parameters();
      if (effect.formula.remembers) effect.rate.set_parameters(effect.values.data());
      if (effect.site() == effects::Site::force) effect.find_slopes();
      if (effect.site() == effects::Site::leakage) effect.find_conductance();
    }
    fresh_ = false;
    always_ = always;
  }

  /// A bit per site, as the store of effects counts them.
  [[nodiscard]] unsigned sites() const { return sites_; }
  [[nodiscard]] bool acts_on(effects::Site site) const { return (sites_ & bit(site)) != 0; }

  /// The motion from which steps begin; memories are empty.
  void start(const Motion<S>& motion) {
    held_ = signals_of(motion);
    for (Effect& effect : effects_) effect.memory = 0.0;
  }

  /// Brings acceleration and memories up to date; call at the end of every step.
  void end_step(const Motion<S>& motion, double step_s) {
    Signals<S> now = signals_of(motion);
    now[kAcceleration] = (motion.v_mps - held_[kSpeed]) * S(1.0 / step_s);
    held_ = now;
    for (Effect& effect : effects_) {
      if (effect.active && effect.formula.remembers) effect.remember(now, step_s);
    }
  }

  /// Speed at the end of the last step.
  [[nodiscard]] const S& held_speed_mps() const { return held_[kSpeed]; }

  /// Chained sites: applies the formulas to x one after the other.
  [[nodiscard]] S chain(effects::Site site, S x, const Motion<S>& motion) const {
    return chain(site, x, signals(motion));
  }
  /// The same in the motion at the end of the last step.
  [[nodiscard]] S chain(effects::Site site, const S& x) const { return chain(site, x, held_); }

  /// Force, leakage and dry friction: sum of the formulas.
  [[nodiscard]] S sum(effects::Site site, const Motion<S>& motion) const {
    Signals<S> at = signals(motion);
    S total = 0.0;
    each_active(site, [&](const Effect& effect) { total += effect.contribution(at); });
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
    explicit Effect(const FormulaView& declared)
        : formula(declared), run(declared.program), curve(declared.curve), rate(declared.memory) {
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

    [[nodiscard]] effects::Site site() const { return formula.place.site; }

    void set_parameters() {
      if (formula.curve.points > 0) {
        curve.set_values(values.data());
      } else {
        run.set_parameters(values.data());
      }
    }

    /// The formula's value within the guard; `none` where it is not finite.
    [[nodiscard]] S result(Signals<S>& at, const S& none) const {
      at[kMemory] = memory;
      return guarded(at, none);
    }
    [[nodiscard]] S contribution(Signals<S>& at) const { return result(at, S(0.0)); }

    /// One step of z' = rate(z), exact where the rate is linear in z and the rest is held.
    void remember(Signals<S> at, double step_s) {
      constexpr double kMostExponent = 50.0;
      constexpr double kSmallExponent = 1e-6;
      const S width = 1e-3 * (formula.ranges[kMemory].max - formula.ranges[kMemory].min) + 1e-9;
      if (site() == effects::Site::command) at[kCommand] = own;  // once per step: this step's
      at[kMemory] = memory + width;
      const S above = rate(at.data());
      at[kMemory] = memory;
      const S now = rate(at.data());
      const S exponent = clamp((above - now) / width * S(step_s), S(-kMostExponent), S(1.0));
      const S whole =
          (exp(exponent) - S(1.0)) / select(abs(exponent) < S(kSmallExponent), S(1.0), exponent);
      const S share = select(abs(exponent) < S(kSmallExponent), S(1.0) + S(0.5) * exponent, whole);
      const S next = memory + now * S(step_s) * share;
      memory = select(abs(next) <= S(kFinite), next, memory);
    }

    /// Slopes of a force over position and speed, the largest for the other signals within their
    /// ranges.
    void find_slopes() {
      max_slope = {};
      each_surrounding([&](Signals<S>& at) {
        max_slope.include(formula.ranges[kPosition], formula.ranges[kSpeed],
                          [&](const S& y_m, const S& v_mps) {
                            at[kPosition] = y_m;
                            at[kSpeed] = v_mps;
                            return guarded(at, S(0.0));
                          });
      });
    }
    void find_conductance() {
      conductance_m3ps_per_Pa = 0.0;
      each_surrounding([&](Signals<S>& at) {
        const S steepest = steepest_m3ps_per_Pa<S>(formula.ranges[kInPressure],
                                                   [&](const S& in_Pa, const S& out_Pa) {
                                                     at[kInPressure] = in_Pa;
                                                     at[kOutPressure] = out_Pa;
                                                     return guarded(at, S(0.0));
                                                   });
        conductance_m3ps_per_Pa = max(conductance_m3ps_per_Pa, S(2.0) * steepest);
      });
    }

    FormulaView formula;
    ExpressionEvaluator<S> run;
    CurveEvaluator<S> curve;      ///< in the place of `run` where the formula is a curve
    ExpressionEvaluator<S> rate;  ///< evaluates dz/dt of the memory
    S memory = 0.0;
    mutable S own = 0.0;  ///< of a chained formula: its own variable when it was last evaluated
    std::vector<S> values;
    std::vector<S> prepared;  ///< state of the last prepare()
    MaxSlope<S> max_slope;
    S conductance_m3ps_per_Pa = 0.0;
    bool active = false;

   private:
    static constexpr double kFinite = 1e300;

    /// The same with the memory that the signals state.
    [[nodiscard]] S guarded(const Signals<S>& at, const S& none) const {
      const S value = formula.curve.points > 0 ? curve(at) : run(at.data());
      const S guard = formula.place.guard;
      return select(abs(value) <= S(kFinite), clamp(value, -guard, guard), none);
    }
    /// Calls f with every signal in the middle of its range, then at its ends where the formula
    /// reads more than the two of its site.
    template <class F>
    void each_surrounding(F&& f) {
      const auto all_at = [&](double share) {
        Signals<S> at;
        for (std::size_t i = 0; i < kSignals; ++i) {
          at[i] = formula.ranges[i].min + share * (formula.ranges[i].max - formula.ranges[i].min);
        }
        return at;
      };
      bool more = false;
      for (std::size_t i = 0; i < formula.program.read_count; ++i) {
        const std::size_t signal = formula.program.reads[i];
        more = more || (signal != formula.place.first && signal != formula.place.second);
      }
      for (const double share : {0.5, 0.0, 1.0}) {
        Signals<S> at = all_at(share);
        f(at);
        if (!more) return;
      }
    }
  };

  static constexpr unsigned bit(effects::Site site) { return 1U << static_cast<unsigned>(site); }

  template <class F>
  void each_active(effects::Site site, F&& f) const {
    for (const Effect& effect : effects_) {
      if (effect.active && effect.site() == site) f(effect);
    }
  }

  [[nodiscard]] Signals<S> signals(const Motion<S>& motion) const {
    Signals<S> at = signals_of(motion);
    at[kAcceleration] = held_[kAcceleration];
    return at;
  }
  [[nodiscard]] S chain(effects::Site site, S x, Signals<S> at) const {
    each_active(site, [&](const Effect& effect) {
      at[effect.formula.place.first] = x;
      effect.own = x;
      x = effect.result(at, x);
    });
    return x;
  }

  std::vector<Effect> effects_;
  Signals<S> held_{};  ///< at the end of the last step
  unsigned sites_ = 0;
  bool fresh_ = false;
  bool always_ = false;  ///< as the last prepare() was called
};

}  // namespace plant_sim::formula
