// The equations of four_way_cylinder.h.
#pragma once

#include "plant_sim/four_way_cylinder.h"

namespace plant_sim {
namespace limits {

inline constexpr double kSmoothDrop_Pa = 1e5;  ///< below it an orifice is no longer a square root

}  // namespace limits

/// q(p): sign(p) sqrt|p| down to 1 bar, then p (5 - (p/p1)^2) / (4 sqrt p1).
template <class S, class Design>
S FourWayCylinder<S, Design>::root(const S& drop_Pa) {
  constexpr double kDrop = limits::kSmoothDrop_Pa;
  const S size = abs(drop_Pa);
  const S outside = sqrt(max(size, S(kDrop)));
  const S scaled = drop_Pa * S(1.0 / kDrop);
  const S inside = drop_Pa * (S(5.0) - scaled * scaled) * S(0.25 / 316.22776601683796);
  const S with_sign = select(drop_Pa < S(0.0), -outside, outside);
  return select(size < S(kDrop), inside, with_sign);
}

template <class S, class Design>
typename FourWayCylinder<S, Design>::Volumes FourWayCylinder<S, Design>::volumes(
    const S& y_m) const {
  return {in_side().dead_volume_m3 + in_side().area_m2 * y_m,
          out_side().dead_volume_m3 + out_side().area_m2 * (parameters.stroke_m - y_m)};
}

/// Force of the oil on the piston, less the weight on an inclined axis.
template <class S, class Design>
S FourWayCylinder<S, Design>::pressure_force_N(const State& x) const {
  if constexpr (Design::kEqualSides) {
    return in_side().area_m2 * (x.in_Pa - x.out_Pa);
  } else {
    return in_side().area_m2 * x.in_Pa - out_side().area_m2 * x.out_Pa - derived_.weight_N;
  }
}

/// Valve opening behind the spool.
template <class S, class Design>
template <bool kEffects>
S FourWayCylinder<S, Design>::opening_m(const State& x) const {
  S opening_m = x.spool_m;
  if constexpr (kEffects) {
    opening_m =
        effects.opening_m(opening_m, derived_.valve_gain_m_per_V, [&] { return motion(x); });
  }
  return opening_m;
}

template <class S, class Design>
typename FourWayCylinder<S, Design>::Edges FourWayCylinder<S, Design>::edges(
    const S& opening_m) const {
  const S& gain = derived_.valve_gain_m_per_V;
  const S lap_m = effects.underlap_m(gain);
  return {effects.edge_m(opening_m + lap_m, gain), effects.edge_m(lap_m - opening_m, gain)};
}

/// Supply pressure that remains under the flow drawn through the open port; with two ports open
/// that of their joint flow to the mean pressure behind them, weighted by their openings, which is
/// exact where both chambers have the same pressure.
template <class S, class Design>
template <bool kEffects>
S FourWayCylinder<S, Design>::inlet_Pa(const State& x, const S& opening_m) const {
  S supply_Pa = parameters.supply_pressure_Pa;
  if constexpr (kEffects) {
    if (effects.laps()) {
      constexpr double kLeast = 1e-150;  // no edge is open
      const auto [ahead_m, back_m] = edges(opening_m);
      const S to_in = in_side().orifice * ahead_m;
      const S to_out = out_side().orifice * back_m;
      const S share = to_out / max(to_in + to_out, S(kLeast));
      const S port_Pa = (S(1.0) - share) * x.in_Pa + share * x.out_Pa;
      return effects.supply_Pa(supply_Pa, port_Pa, to_in + to_out);
    }
    const auto extends = opening_m >= S(0.0);
    const S flow = select(extends, in_side().orifice, out_side().orifice) * opening_m;
    supply_Pa = effects.supply_Pa(supply_Pa, select(extends, x.in_Pa, x.out_Pa), abs(flow));
  }
  return supply_Pa;
}

template <class S, class Design>
PressuresOf<S> FourWayCylinder<S, Design>::pressures() const {
  return {inlet_Pa<true>(state, opening_m<true>(state)), state.in_Pa, state.out_Pa};
}

/// Flows of ports with both edges open near null; where none is at null those of one edge, bit for
/// bit.
template <class S, class Design>
typename FourWayCylinder<S, Design>::Flows FourWayCylinder<S, Design>::lapped_flows(
    const State& x, const S& opening_m) const {
  const S supply_Pa = inlet_Pa<true>(x, opening_m);
  const S return_Pa = parameters.return_pressure_Pa;
  const auto [ahead_m, back_m] = edges(opening_m);
  const S in_orifice = in_side().orifice;
  const S out_orifice = out_side().orifice;
  return {in_orifice * ahead_m * root(supply_Pa - x.in_Pa) -
              in_orifice * back_m * root(x.in_Pa - return_Pa),
          out_orifice * ahead_m * root(x.out_Pa - return_Pa) -
              out_orifice * back_m * root(supply_Pa - x.out_Pa)};
}

/// Part of an edge's flow that is left behind a throttle in series with it.
template <class S, class Design>
S FourWayCylinder<S, Design>::cushion_ratio(const S& edge, const S& throttle) {
  constexpr double kLeast = 1e-300;  // both are shut
  return throttle / sqrt(max(edge * edge + throttle * throttle, S(kLeast)));
}

/// Flows that the end cushions let out of either chamber.
template <class S, class Design>
template <bool kEffects>
void FourWayCylinder<S, Design>::throttle_ends(const State& x, const S& opening_m, Flows& q) const {
  S open_m = abs(opening_m);
  if (kEffects && effects.laps()) {
    const auto [ahead_m, back_m] = edges(opening_m);
    open_m = ahead_m + back_m;
  }
  const EndCushions<S>& c = derived_.cushions;
  const S zero = 0.0;
  const auto retracting = (x.y_m < c.retracted_m) & (q.in_m3ps < zero);
  const auto extending = (parameters.stroke_m - x.y_m < c.extended_m) & (q.out_m3ps > zero);
  const S in_ratio = cushion_ratio(in_side().orifice * open_m, c.retracted);
  const S out_ratio = cushion_ratio(out_side().orifice * open_m, c.extended);
  q.in_m3ps = q.in_m3ps * select(retracting, in_ratio, S(1.0));
  q.out_m3ps = q.out_m3ps * select(extending, out_ratio, S(1.0));
}

template <class S, class Design>
template <bool kEffects>
typename FourWayCylinder<S, Design>::Flows FourWayCylinder<S, Design>::flows(const State& x) const {
  const Parameters& p = parameters;
  const S open_m = opening_m<kEffects>(x);
  Flows q;
  if (kEffects && effects.laps()) {
    q = lapped_flows(x, open_m);
  } else {
    const auto extends = open_m >= S(0.0);
    const S supply_Pa = inlet_Pa<kEffects>(x, open_m);
    const S in_flow = in_side().orifice * open_m;
    const S out_flow = out_side().orifice * open_m;
    q.in_m3ps =
        in_flow * root(select(extends, supply_Pa - x.in_Pa, x.in_Pa - p.return_pressure_Pa));
    q.out_m3ps =
        out_flow * root(select(extends, x.out_Pa - p.return_pressure_Pa, supply_Pa - x.out_Pa));
  }
  if (derived_.cushioned) throttle_ends<kEffects>(x, open_m, q);
  if constexpr (kEffects) {
    const auto at = [&] { return motion(x); };
    const effects::Leak<S> leak = effects.leak(x.in_Pa, x.out_Pa, at);
    q.in_m3ps = effects.flow_m3ps(q.in_m3ps, at) - leak.in_m3ps;
    q.out_m3ps = effects.flow_m3ps(q.out_m3ps, at) + leak.out_m3ps;
  }
  return q;
}

template <class S, class Design>
template <bool kLimits, bool kEffects>
typename FourWayCylinder<S, Design>::State FourWayCylinder<S, Design>::rate(
    const State& x, const S& u_V, const S& from_y_m, const S& pull_mps2) const {
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
  const S in_swept_m3ps = in_side().area_m2 * v_mps;
  const S out_swept_m3ps = out_side().area_m2 * v_mps;
  const Volumes volume = volumes(y_m);
  S in_beta_Pa = p.bulk_modulus_Pa;
  S out_beta_Pa = p.bulk_modulus_Pa;
  S force_N =
      pressure_force_N(x) - p.damping_N_s_per_m * v_mps - derived_.disturbed.driven * disturbance_N;
  if constexpr (kEffects) {
    in_beta_Pa = effects.bulk_modulus_Pa(in_beta_Pa, x.in_Pa);
    out_beta_Pa = effects.bulk_modulus_Pa(out_beta_Pa, x.out_Pa);
    force_N += derived_.mass_kg * pull_mps2;
    force_N = effects.net_force_N(y_m, {v_mps, x.y_m - from_y_m, force_N, arrest_kg_per_s_},
                                  [&] { return motion(x); });
  }
  State r;
  r.y_m = v_mps;
  r.v_mps = force_N * derived_.inverse_mass;
  r.in_Pa = in_beta_Pa / volume.in_m3 * (q.in_m3ps - in_swept_m3ps);
  r.out_Pa = out_beta_Pa / volume.out_m3 * (out_swept_m3ps - q.out_m3ps);
  r.spool_m = x.spool_mps;
  r.spool_mps =
      derived_.kv_wv2 * u_V - derived_.two_zeta_wv * x.spool_mps - derived_.wv2 * x.spool_m;
  if constexpr (!Design::kEqualSides) {
    const auto lags = derived_.lag_rate > zero;
    const S towards_mps = derived_.lag_rate * (derived_.valve_gain_m_per_V * u_V - x.spool_m);
    r.spool_m = select(lags, towards_mps, r.spool_m);
    r.spool_mps = select(lags, -derived_.lag_rate * x.spool_mps, r.spool_mps);
  }
  if constexpr (kEffects) {
    const S most_mps = derived_.spool_limit_mps;
    r.spool_m = clamp(r.spool_m, -most_mps, most_mps);
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
