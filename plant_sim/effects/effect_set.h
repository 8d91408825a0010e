// All effects of the table in one object: per site, the sum or chain of the contributions of the
// active effects (site.h defines the sites).
#pragma once

#include <limits>

#include "plant_sim/effects/effect_store.h"

namespace plant_sim::effects {

template <class S, template <class> class... E>
class EffectSet : public EffectStore<S, E...> {
  using Store = EffectStore<S, E...>;
  template <class T>
  using Tag = typename Store::template Tag<T>;
  using Store::formulas_;

 public:
  // `motion` gives the formula::Motion<S> at the instant; it is asked for only where a formula
  // acts.

  /// As EffectStore::prepare().
  void prepare(double step_s) {
    Store::prepare(step_s);
    friction_ratio_ = 1.0;
    half_step_s_ = 0.5 * step_s;
  }

  /// Sets the level of dry friction to that in the middle of a step. Where friction_varies(), call
  /// it at the beginning of every step.
  template <class Motion>
  void weigh_friction(Motion&& motion) {
    constexpr double kLeast = 1e-3;
    formula::Motion<S> at = motion();
    at.y_m += S(half_step_s_) * at.v_mps;
    friction_ratio_ = max(S(1.0) + formulas_.sum(Site::dry_friction, at), S(kLeast));
  }

  /// Call exactly once per step.
  template <class Motion>
  [[nodiscard]] S command_V(S u_V, Motion&& motion) {
    this->template for_each_active<Site::command>(
        [&]<class T>(Tag<T>, const auto& p, auto& memory) { u_V = T::command_V(p, memory, u_V); });
    u_V = apply_formulas<Site::command>(u_V, motion);
    this->template for_each_active<Site::amplifier>(
        [&]<class T>(Tag<T>, const auto& p, const auto&) { u_V = T::amplified_V(p, u_V); });
    return u_V;
  }

  /// Call exactly once per step, with command_V().
  [[nodiscard]] S drive_V(S u_V) {
    this->template for_each_active<Site::drive>(
        [&]<class T>(Tag<T>, const auto& p, auto& memory) { u_V = T::drive_V(p, memory, u_V); });
    return u_V;
  }

  /// Call exactly once per step, with command_V().
  [[nodiscard]] S set_mps(S asked_mps, const S& moving_mps) {
    this->template for_each_active<Site::set_speed>(
        [&]<class T>(Tag<T>, const auto& p, auto& memory) {
          asked_mps = T::set_mps(p, memory, asked_mps, moving_mps);
        });
    return asked_mps;
  }

  [[nodiscard]] S inertia_ratio() const {
    S most = 0.0;
    this->template for_each_active<Site::lag>([&]<class T>(Tag<T>, const auto& p, const auto&) {
      most = max(most, T::inertia_ratio(p));
    });
    return most;
  }

  /// Call after a reset with the motion that steps begin from.
  template <class Motion>
  void start(Motion&& motion) {
    if (formulas_.size() > 0) formulas_.start(motion());
  }
  /// Speed at the end of the last step, where a formula acts.
  [[nodiscard]] const S& held_speed_mps() const { return formulas_.held_speed_mps(); }
  /// Call at the end of every step with the motion that it has led to.
  template <class Motion>
  void end_step(Motion&& motion, double step_s) {
    if (formulas_.sites() != 0) formulas_.end_step(motion(), step_s);
  }

  [[nodiscard]] S spool_limit_mps() const {
    S least = std::numeric_limits<double>::infinity();
    this->template for_each_active<Site::spool>([&]<class T>(Tag<T>, const auto& p, const auto&) {
      least = min(least, T::spool_limit_mps(p));
    });
    return least;
  }

  /// Behind a spool at `x_m`.
  template <class Motion>
  [[nodiscard]] S opening_m(S x_m, const S& gain_m_per_V, Motion&& motion) const {
    this->template for_each_active<Site::opening>([&]<class T>(Tag<T>, const auto& p, const auto&) {
      x_m = T::opening_m(p, x_m, gain_m_per_V);
    });
    return apply_formulas<Site::opening>(x_m, motion);
  }

  /// True when edges of the valve are open at null, or leak.
  [[nodiscard]] bool laps() const { return this->acts_on(Site::lap) || this->acts_on(Site::edge); }

  /// Opening of every edge of the valve at null.
  [[nodiscard]] S underlap_m(const S& gain_m_per_V) const {
    S sum = 0.0;
    this->template for_each_active<Site::lap>([&]<class T>(Tag<T>, const auto& p, const auto&) {
      sum += T::underlap_m(p, gain_m_per_V);
    });
    return sum;
  }

  /// Opening of an edge of the valve whose land is `ahead_m` ahead of it.
  [[nodiscard]] S edge_m(S ahead_m, const S& gain_m_per_V) const {
    this->template for_each_active<Site::edge>([&]<class T>(Tag<T>, const auto& p, const auto&) {
      ahead_m = T::edge_m(p, ahead_m, gain_m_per_V);
    });
    return max(ahead_m, S(0.0));
  }

  [[nodiscard]] S supply_Pa(S supply_Pa, const S& port_Pa, const S& flow) const {
    this->template for_each_active<Site::supply>([&]<class T>(Tag<T>, const auto& p, const auto&) {
      supply_Pa = T::supply_Pa(p, supply_Pa, port_Pa, flow);
    });
    return supply_Pa;
  }

  template <class Motion>
  [[nodiscard]] S flow_m3ps(S flow_m3ps, Motion&& motion) const {
    this->template for_each_active<Site::flow>([&]<class T>(Tag<T>, const auto& p, const auto&) {
      flow_m3ps = T::flow_m3ps(p, flow_m3ps);
    });
    return apply_formulas<Site::flow>(flow_m3ps, motion);
  }

  template <class Motion>
  [[nodiscard]] Leak<S> leak(const S& in_Pa, const S& out_Pa, Motion&& motion) const {
    Leak<S> sum;
    this->template for_each_active<Site::leakage>([&]<class T>(Tag<T>, const auto& p, const auto&) {
      const Leak<S> one = T::leak(p, in_Pa, out_Pa);
      sum.in_m3ps += one.in_m3ps;
      sum.out_m3ps += one.out_m3ps;
    });
    if (formulas_.acts_on(Site::leakage)) {
      const S across_m3ps = formulas_.sum(Site::leakage, motion());
      sum.in_m3ps += across_m3ps;
      sum.out_m3ps -= across_m3ps;
    }
    return sum;
  }

  [[nodiscard]] S conductance_m3ps_per_Pa() const {
    S sum = 0.0;
    this->template for_each_active<Site::leakage>(
        [&]<class T>(Tag<T>, const auto& p, const auto&) { sum += T::conductance_m3ps_per_Pa(p); });
    return sum + formulas_.conductance_m3ps_per_Pa();
  }

  [[nodiscard]] S bulk_modulus_Pa(S modulus_Pa, const S& at_Pa) const {
    this->template for_each_active<Site::bulk_modulus>(
        [&]<class T>(Tag<T>, const auto& p, const auto&) {
          modulus_Pa = T::bulk_modulus_Pa(p, modulus_Pa, at_Pa);
        });
    return modulus_Pa;
  }

  [[nodiscard]] S added_mass_kg() const {
    S sum = 0.0;
    this->template for_each_active<Site::inertia>(
        [&]<class T>(Tag<T>, const auto& p, const auto&) { sum += T::added_mass_kg(p); });
    return sum;
  }

  /// True when part of the mass is behind a spring: step by coupled_step().
  [[nodiscard]] bool coupled() const { return this->acts_on(Site::coupling); }

  /// Share of the moving mass behind the spring; the rest is driven.
  [[nodiscard]] S coupled_ratio() const {
    S sum = 0.0;
    this->template for_each_active<Site::coupling>(
        [&]<class T>(Tag<T>, const auto& p, const auto&) { sum += T::coupled_ratio(p); });
    return sum;
  }

  /// Place of the sensor: 0 on the driven part, 1 on the second mass.
  [[nodiscard]] S sensor_place() const {
    S sum = 0.0;
    this->template for_each_active<Site::coupling>(
        [&]<class T>(Tag<T>, const auto& p, const auto&) { sum += T::sensor_place(p); });
    return sum;
  }

  [[nodiscard]] S coupling_rate_per_s() const {
    S fastest = 0.0;
    this->template for_each_active<Site::coupling>(
        [&]<class T>(Tag<T>, const auto& p, const auto&) {
          fastest = max(fastest, T::coupling_rate_per_s(p));
        });
    return fastest;
  }

  [[nodiscard]] S pull_mps2(const CouplingOffset<S>& offset) const {
    S sum = 0.0;
    this->template for_each_active<Site::coupling>(
        [&]<class T>(Tag<T>, const auto& p, const auto&) { sum += T::pull_mps2(p, offset); });
    return sum;
  }

  [[nodiscard]] CouplingOffset<S> offset() const {
    CouplingOffset<S> found;
    this->template for_each_active<Site::coupling>(
        [&]<class T>(Tag<T>, const auto&, const auto& memory) { found = memory.offset; });
    return found;
  }

  void set_offset(const CouplingOffset<S>& offset) {
    this->template for_each_active<Site::coupling>(
        [&]<class T>(Tag<T>, const auto&, auto& memory) { memory.offset = offset; });
  }

  /// The driven part has lost this speed at a stop; the second mass has not.
  void stop_driven(const S& lost_mps) {
    this->template for_each_active<Site::coupling>(
        [&]<class T>(Tag<T>, const auto&, auto& memory) { memory.offset.offset_mps += lost_mps; });
  }

  /// Sum of all forces against extension but dry friction.
  template <class Motion>
  [[nodiscard]] S resisting_N(const S& y_m, const S& v_mps, Motion&& motion) const {
    S sum_N = 0.0;
    this->template for_each_active<Site::force>([&]<class T>(Tag<T>, const auto& p, const auto&) {
      sum_N += T::resisting_N(p, y_m, v_mps);
    });
    if (formulas_.acts_on(Site::force)) {
      formula::Motion<S> at = motion();
      at.y_m = y_m;
      at.v_mps = v_mps;
      sum_N += formulas_.sum(Site::force, at);
    }
    return sum_N;
  }

  /// contact.drive_N less all resisting forces and dry friction; each dry friction sees the force
  /// that remains after those before it.
  template <class Motion>
  [[nodiscard]] S net_force_N(const S& y_m, DryContact<S> contact, Motion&& motion) const {
    contact.drive_N -= resisting_N(y_m, contact.v_mps, motion);
    contact.drive_N = of_full_friction(contact.drive_N);
    contact.arrest_kg_per_s = of_full_friction(contact.arrest_kg_per_s);
    this->template for_each_active<Site::dry_friction>(
        [&]<class T>(Tag<T>, const auto& p, const auto& memory) {
          contact.drive_N -= T::friction_N(p, memory, contact);
        });
    return friction_varies() ? friction_ratio_ * contact.drive_N : contact.drive_N;
  }

  /// True when formulas change the level of dry friction from step to step.
  [[nodiscard]] bool friction_varies() const { return formulas_.acts_on(Site::dry_friction); }

  /// Sums over all dry frictions, in this step. `most_arrest_kg_per_s` is that of the function in
  /// rigid_contact.h.
  [[nodiscard]] ContactLevels<S> contact_levels(const S& most_arrest_kg_per_s) const {
    ContactLevels<S> sum;
    const S arrest_kg_per_s = of_full_friction(most_arrest_kg_per_s);
    this->template for_each_active<Site::dry_friction>(
        [&]<class T>(Tag<T>, const auto& p, const auto&) {
          const ContactLevels<S> one = T::levels(p, arrest_kg_per_s);
          sum.holding_N += friction_ratio_ * one.holding_N;
          sum.braking_N += friction_ratio_ * one.braking_N;
          sum.gradual_N += friction_ratio_ * one.gradual_N;
          sum.spring_N_per_m += friction_ratio_ * one.spring_N_per_m;
        });
    return sum;
  }

  /// The most that a dry friction asks for.
  [[nodiscard]] S turn_parts(TurningPart<S> step) const {
    S parts = 1.0;
    step.free_N = of_full_friction(step.free_N);
    step.inverse_mass_per_kg = step.inverse_mass_per_kg * friction_ratio_;
    this->template for_each_active<Site::dry_friction>(
        [&]<class T>(Tag<T>, const auto& p, const auto& memory) {
          if constexpr (requires { T::turn_parts(p, memory, step); })
            parts = max(parts, T::turn_parts(p, memory, step));
        });
    return parts;
  }

  /// At speeds from `least_mps` to `v_mps`; `most_arrest_kg_per_s` as for contact_levels().
  [[nodiscard]] S slope_N_s_per_m(const S& v_mps, const S& least_mps,
                                  const S& most_arrest_kg_per_s) const {
    S sum = 0.0;
    const S arrest_kg_per_s = of_full_friction(most_arrest_kg_per_s);
    this->template for_each_active<Site::force>([&]<class T>(Tag<T>, const auto& p, const auto&) {
      if constexpr (requires { T::slope_N_s_per_m(p, v_mps); }) sum += T::slope_N_s_per_m(p, v_mps);
    });
    this->template for_each_active<Site::dry_friction>(
        [&]<class T>(Tag<T>, const auto& p, const auto&) {
          if constexpr (requires { T::slope_N_s_per_m(p, least_mps, arrest_kg_per_s); })
            sum += friction_ratio_ * T::slope_N_s_per_m(p, least_mps, arrest_kg_per_s);
        });
    if (formulas_.acts_on(Site::force)) sum += formulas_.slope_N_s_per_m(v_mps);
    return sum;
  }

  /// At any speed.
  [[nodiscard]] S stiffness_N_per_m() const {
    return library_stiffness_N_per_m() + formulas_.stiffness_N_per_m();
  }
  /// At any speed up to |v_mps|.
  [[nodiscard]] S stiffness_N_per_m(const S& v_mps) const {
    return library_stiffness_N_per_m() + formulas_.stiffness_N_per_m(v_mps);
  }
  [[nodiscard]] bool stiffness_varies() const {
    return formulas_.acts_on(Site::force) || friction_varies();
  }

  [[nodiscard]] S reading_m(S y_m) const {
    this->template for_each_active<Site::sensor>(
        [&]<class T>(Tag<T>, const auto& p, const auto& memory) {
          y_m = T::reading_m(p, memory, y_m);
        });
    return formulas_.acts_on(Site::sensor) ? formulas_.chain(Site::sensor, y_m) : y_m;
  }

  /// Call once per accepted integration step.
  void accept(const S& travel_m, const S& v_mps) {
    this->for_each_active([&]<class T>(Tag<T>, const auto& p, auto& memory) {
      if constexpr (requires { T::accept(p, memory, travel_m, v_mps); }) {
        T::accept(p, memory, travel_m, v_mps);
      }
    });
  }

 private:
  [[nodiscard]] S library_stiffness_N_per_m() const {
    S sum = 0.0;
    this->template for_each_active<Site::force>([&]<class T>(Tag<T>, const auto& p, const auto&) {
      if constexpr (requires { T::stiffness_N_per_m(p); }) sum += T::stiffness_N_per_m(p);
    });
    this->template for_each_active<Site::dry_friction>(
        [&]<class T>(Tag<T>, const auto& p, const auto&) {
          if constexpr (requires { T::stiffness_N_per_m(p); })
            sum += friction_ratio_ * T::stiffness_N_per_m(p);
        });
    return sum;
  }

  /// Chains the formulas of a site behind its effects.
  template <Site kSite, class Motion>
  [[nodiscard]] S apply_formulas(const S& x, Motion& motion) const {
    return formulas_.acts_on(kSite) ? formulas_.chain(kSite, x, motion()) : x;
  }

  /// Scales a force on a contact to friction of its parameters' level: all forces of a friction go
  /// with its level.
  [[nodiscard]] S of_full_friction(const S& x) const {
    return friction_varies() ? x / friction_ratio_ : x;
  }

  double half_step_s_ = 0.0;
  S friction_ratio_ = 1.0;  ///< level of dry friction over that of its parameters, > 0
};

}  // namespace plant_sim::effects
