// The equations of hydraulic_actuator.h.
#pragma once

#include "plant_sim/hydraulic_actuator.h"

namespace plant_sim {
namespace limits {

inline constexpr double kSmoothDrop_Pa = 1e5;  ///< below it an orifice is no longer a square root

}  // namespace limits

/// q(p): sign(p) sqrt|p| down to 1 bar, then p (5 - (p/p1)^2) / (4 sqrt p1).
template <class S>
S HydraulicActuator<S>::root(const S& drop_Pa) {
  constexpr double kDrop = limits::kSmoothDrop_Pa;
  const S size = abs(drop_Pa);
  const S outside = sqrt(max(size, S(kDrop)));
  const S scaled = drop_Pa * S(1.0 / kDrop);
  const S inside = drop_Pa * (S(5.0) - scaled * scaled) * S(0.25 / 316.22776601683796);
  const S with_sign = select(drop_Pa < S(0.0), -outside, outside);
  return select(size < S(kDrop), inside, with_sign);
}

/// G xv of the opening: an orifice's flow per square root of its drop.
template <class S>
template <bool kEffects>
S HydraulicActuator<S>::valve_flow(const State& x) const {
  S opening_m = x.spool_m;
  if constexpr (kEffects) opening_m = effects.opening_m(opening_m, parameters.valve_gain_m_per_V);
  return derived_.orifice * opening_m;
}

/// Supply pressure that remains under the drawn flow.
template <class S>
template <bool kEffects>
S HydraulicActuator<S>::inlet_Pa(const State& x, const S& flow) const {
  S supply_Pa = parameters.supply_pressure_Pa;
  if constexpr (kEffects) {
    supply_Pa = effects.supply_Pa(supply_Pa, select(flow >= S(0.0), x.in_Pa, x.out_Pa), abs(flow));
  }
  return supply_Pa;
}

template <class S>
PressuresOf<S> HydraulicActuator<S>::pressures() const {
  return {inlet_Pa<true>(state, valve_flow<true>(state)), state.in_Pa, state.out_Pa};
}

template <class S>
template <bool kEffects>
typename HydraulicActuator<S>::Flows HydraulicActuator<S>::flows(const State& x) const {
  const Parameters& p = parameters;
  const S flow = valve_flow<kEffects>(x);
  const auto extends = flow >= S(0.0);
  const S supply_Pa = inlet_Pa<kEffects>(x, flow);
  Flows q;
  q.in_m3ps = flow * root(select(extends, supply_Pa - x.in_Pa, x.in_Pa - p.return_pressure_Pa));
  q.out_m3ps = flow * root(select(extends, x.out_Pa - p.return_pressure_Pa, supply_Pa - x.out_Pa));
  if constexpr (kEffects) {
    const effects::Leak<S> leak = effects.leak(x.in_Pa, x.out_Pa);
    q.in_m3ps = effects.flow_m3ps(q.in_m3ps) - leak.in_m3ps;
    q.out_m3ps = effects.flow_m3ps(q.out_m3ps) + leak.out_m3ps;
  }
  return q;
}

template <class S>
template <bool kLimits, bool kEffects>
typename HydraulicActuator<S>::State HydraulicActuator<S>::rate(const State& x, const S& u_V,
                                                                const S& from_y_m,
                                                                const S& pull_mps2) const {
  const Parameters& p = parameters;
  const S zero = 0.0;
  S y_m = x.y_m;
  S v_mps = x.v_mps;
  if constexpr (kLimits) {
    y_m = clamp(y_m, zero, p.stroke_m);
    v_mps = select(y_m <= zero, max(v_mps, zero), v_mps);
    v_mps = select(y_m >= p.stroke_m, min(v_mps, zero), v_mps);
  }
  const Flows q = flows<kEffects>(x);
  const S swept_m3ps = p.area_m2 * v_mps;
  S in_beta_Pa = p.bulk_modulus_Pa;
  S out_beta_Pa = p.bulk_modulus_Pa;
  S force_N = p.area_m2 * (x.in_Pa - x.out_Pa) - p.damping_N_s_per_m * v_mps;
  if constexpr (kEffects) {
    in_beta_Pa = effects.bulk_modulus_Pa(in_beta_Pa, x.in_Pa);
    out_beta_Pa = effects.bulk_modulus_Pa(out_beta_Pa, x.out_Pa);
    force_N += derived_.mass_kg * pull_mps2;
    force_N =
        effects.net_force_N(y_m, {v_mps, x.y_m - from_y_m, force_N, derived_.arrest_kg_per_s});
  }
  State r;
  r.y_m = v_mps;
  r.v_mps = force_N * derived_.inverse_mass;
  r.in_Pa = in_beta_Pa / (p.dead_volume_m3 + p.area_m2 * y_m) * (q.in_m3ps - swept_m3ps);
  r.out_Pa =
      out_beta_Pa / (p.dead_volume_m3 + p.area_m2 * (p.stroke_m - y_m)) * (swept_m3ps - q.out_m3ps);
  r.spool_m = x.spool_mps;
  r.spool_mps =
      derived_.kv_wv2 * u_V - derived_.two_zeta_wv * x.spool_mps - derived_.wv2 * x.spool_m;
  if constexpr (kEffects) {
    const S most_mps = derived_.spool_limit_mps;
    r.spool_m = clamp(x.spool_mps, -most_mps, most_mps);
    r.spool_mps = select(x.spool_mps >= most_mps, min(r.spool_mps, zero), r.spool_mps);
    r.spool_mps = select(x.spool_mps <= -most_mps, max(r.spool_mps, zero), r.spool_mps);
  }
  if constexpr (kLimits) {
    r.v_mps = select(y_m <= zero, max(r.v_mps, zero), r.v_mps);
    r.v_mps = select(y_m >= p.stroke_m, min(r.v_mps, zero), r.v_mps);
    r.in_Pa = select(x.in_Pa <= zero, max(r.in_Pa, zero), r.in_Pa);
    r.out_Pa = select(x.out_Pa <= zero, max(r.out_Pa, zero), r.out_Pa);
  }
  return r;
}

}  // namespace plant_sim
