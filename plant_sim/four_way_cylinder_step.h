// One step of four_way_cylinder.h: how it is divided, integrated and kept within the limits.
#pragma once

#include "plant_sim/four_way_cylinder.h"
#include "plant_sim/guard.h"
#include "plant_sim/rigid_contact.h"

/// Before a function that is compiled as one with all that it calls: the wide ensembles' step.
#ifdef PLANT_SIM_WHOLE_STEPS
#define PLANT_SIM_WHOLE [[gnu::flatten]]
#else
#define PLANT_SIM_WHOLE
#endif

namespace plant_sim {
namespace limits {

inline constexpr double kLowPressure_Pa = 1e5;    ///< pressures below are checked for cavitation
inline constexpr double kHighPressure_Pa = 1e10;  ///< numerical guard, beyond any oil
inline constexpr double kSpool_m = 1.0;           ///< numerical guard
inline constexpr double kSpool_mps = 1e5;         ///< numerical guard
inline constexpr double kCornerDivisions =
    8.0;  ///< divisions of a step in which the spool meets its limit

}  // namespace limits

/// Pressures of a piston at rest: equal areas half way between supply and return; otherwise the
/// balance with weight and load at which a centred valve lets as much oil into either chamber as
/// out of it,
///   Ai Pi - Ao Po = F,   Pi + Po = Ps + Pe
/// (a port's two edges open by the ratio r pass equal flows at (Ps - Pi) / (Pi - Pe) = r^2, those
/// of the other port at 1/r^2).
template <class S, class Design>
void FourWayCylinder<S, Design>::rest_pressures(State& x) const {
  const Parameters& p = parameters;
  const S sum_Pa = p.supply_pressure_Pa + p.return_pressure_Pa;
  if constexpr (Design::kEqualSides) {
    x.in_Pa = S(0.5) * sum_Pa;
    x.out_Pa = x.in_Pa;
  } else {
    const S load_N = derived_.weight_N + effects.resisting_N(x.y_m, S(0.0), [&] {
      return formula::Motion<S>{.y_m = x.y_m};
    });
    const S in_m2 = in_side().area_m2;
    const S out_m2 = out_side().area_m2;
    x.in_Pa = clamp((out_m2 * sum_Pa + load_N) / (in_m2 + out_m2), p.return_pressure_Pa,
                    p.supply_pressure_Pa);
    x.out_Pa =
        clamp((in_m2 * x.in_Pa - load_N) / out_m2, p.return_pressure_Pa, p.supply_pressure_Pa);
  }
}

template <class S, class Design>
void FourWayCylinder<S, Design>::reset() {
  effects.reset();
  drive_V_ = 0.0;
  state.y_m = initial.y_m;
  rest_pressures(state);
  const auto or_rest = [](const S& given, const S& rest) {
    return select(given >= S(0.0), given, rest);
  };
  state = {initial.y_m,
           initial.v_mps,
           or_rest(initial.pressure_in_Pa, state.in_Pa),
           or_rest(initial.pressure_out_Pa, state.out_Pa),
           initial.spool_m,
           initial.spool_mps};
  keep_within_limits();
  effects.start([&] { return motion(state); });
}

template <class S, class Design>
void FourWayCylinder<S, Design>::prepare(double step_s) {
  Parameters& p = parameters;
  p.visit(
      [](const ParameterInfo& info, S& value) { value = clamp(value, S(info.min), S(info.max)); });
  effects.prepare(step_s);
  const SpoolDynamics<S> spool = Design::spool(p, step_s);
  derived_.step_s = step_s;
  derived_.in = Design::in_side(p);
  if constexpr (!Design::kEqualSides) derived_.out = Design::out_side(p);
  derived_.cushions = Design::cushions(p);
  derived_.cushioned =
      !all(max(derived_.cushions.retracted_m, derived_.cushions.extended_m) <= S(0.0));
  derived_.most_orifice = max(in_side().orifice, out_side().orifice);
  derived_.valve_gain_m_per_V = spool.gain_m_per_V;
  derived_.two_zeta_wv = spool.two_zeta_wv_per_s;
  derived_.wv2 = spool.wv_rad_per_s * spool.wv_rad_per_s;
  derived_.kv_wv2 = spool.gain_m_per_V * derived_.wv2;
  derived_.lag_rate = spool.lag_rate_per_s;
  const S mass_kg = p.mass_kg + effects.added_mass_kg();
  derived_.mass_kg = mass_kg * (S(1.0) - effects.coupled_ratio());
  derived_.disturbed = disturbed_parts(effects, mass_kg, disturbance_place);
  derived_.inverse_mass = S(1.0) / derived_.mass_kg;
  derived_.most_arrest_kg_per_s = most_arrest_kg_per_s(derived_.mass_kg, step_s);
  take_contact();
  arrest_kg_per_s_ = derived_.mass_kg * S(1.0 / step_s);
  if constexpr (!Design::kEqualSides) derived_.weight_N = Design::weight_N(p, mass_kg);
  derived_.steady_rate = max(max(spool.wv_rad_per_s, derived_.two_zeta_wv), derived_.lag_rate);
  derived_.spool_limit_mps = effects.spool_limit_mps();
  constexpr double kFiner = limits::kRateStep / limits::kResonanceStep;
  const S coupling_rate = S(kFiner) * effects.coupling_rate_per_s();
  derived_.stiffness_N_per_m =
      effects.stiffness_N_per_m() + derived_.mass_kg * coupling_rate * coupling_rate;
  derived_.conductance_m3ps_per_Pa = effects.conductance_m3ps_per_Pa();
}

/// Largest opening that the step can come to; where edges are open at null that of both edges of a
/// port.
template <class S, class Design>
S FourWayCylinder<S, Design>::reach_m(const S& u_V) const {
  const S spool_m = max(abs(state.spool_m), derived_.valve_gain_m_per_V * abs(u_V)) +
                    abs(state.spool_mps) * S(derived_.step_s);
  if (!effects.any()) return spool_m;
  const S& gain = derived_.valve_gain_m_per_V;
  const auto at = [&] { return motion(state); };
  const S opening_m = max(spool_m, max(abs(effects.opening_m(spool_m, gain, at)),
                                       abs(effects.opening_m(-spool_m, gain, at))));
  if (!effects.laps()) return opening_m;
  const auto [ahead_m, back_m] = edges(opening_m);
  const auto [null_ahead_m, null_back_m] = edges(S(0.0));
  return max(ahead_m, back_m) + max(null_ahead_m, null_back_m);
}

/// The fastest that the rod can become within the step by the disturbance and the forces of
/// effects.
template <class S, class Design>
S FourWayCylinder<S, Design>::fast_mps() const {
  const S v_mps = state.v_mps;
  S push_N = S(0.0) - derived_.disturbed.driven * disturbance_N;
  if (effects.any()) {
    push_N = effects.net_force_N(
        state.y_m, {v_mps, S(0.0), push_N, derived_.mass_kg * S(1.0 / derived_.step_s)},
        [&] { return motion(state); });
  }
  return abs(v_mps) + abs(push_N) * derived_.inverse_mass * S(derived_.step_s);
}

/// Sum of all forces on the rod but dry friction.
template <class S, class Design>
S FourWayCylinder<S, Design>::free_N() const {
  const S& v_mps = state.v_mps;
  return pressure_force_N(state) - parameters.damping_N_s_per_m * v_mps -
         derived_.disturbed.driven * disturbance_N -
         effects.resisting_N(state.y_m, v_mps, [&] { return motion(state); });
}

template <class S, class Design>
void FourWayCylinder<S, Design>::take_contact() {
  derived_.contact = effects.contact_levels(derived_.most_arrest_kg_per_s);
  derived_.brakes = !all(derived_.contact.braking_N <= S(0.0));
  derived_.turns_gradually = !all(derived_.contact.gradual_N <= S(0.0));
  derived_.yields = !all(derived_.contact.spring_N_per_m <= S(0.0));
}

/// The slowest that the rod can become within the step.
template <class S, class Design>
S FourWayCylinder<S, Design>::slow_mps(const S& free_N) const {
  return least_speed_mps(state.v_mps, free_N, derived_.contact,
                         S(derived_.step_s) * derived_.inverse_mass);
}

/// Mask of the lanes in which the whole step reaches no limit.
template <class S, class Design>
auto FourWayCylinder<S, Design>::ordinary(const S& u_V) const {
  const Parameters& p = parameters;
  const State& x = state;
  const S step_s = derived_.step_s;
  const S speed_mps = fast_mps();
  const S travel_m = S(4.0) * speed_mps * step_s + S(1e-3) * p.stroke_m;
  const S room_m = min(x.y_m, p.stroke_m - x.y_m);
  const auto [in_m3, out_m3] = volumes(x.y_m);
  const S small_m3 = min(in_m3, out_m3);
  const S low_Pa = min(x.in_Pa, x.out_Pa);
  const S high_Pa = max(x.in_Pa, x.out_Pa);
  // the smallest drop over any open or shut orifice, and the largest opening within the step
  const S drop_Pa =
      min(min(abs(p.supply_pressure_Pa - x.in_Pa), abs(p.supply_pressure_Pa - x.out_Pa)),
          low_Pa - p.return_pressure_Pa);
  const S flow_rate = derived_.most_orifice * reach_m(u_V) * p.bulk_modulus_Pa * step_s;
  const S allowed = S(2.0 * limits::kRateStep) * small_m3;
  const S in_m2 = in_side().area_m2;
  const S out_m2 = out_side().area_m2;
  const S most_m2 = Design::kEqualSides ? in_m2 : max(in_m2, out_m2);
  const S oil = Design::kEqualSides
                    ? p.bulk_modulus_Pa * in_m2 * in_m2 * (in_m3 + out_m3)
                    : p.bulk_modulus_Pa * (in_m2 * in_m2 * out_m3 + out_m2 * out_m2 * in_m3);
  const S stiffness = (oil + derived_.stiffness_N_per_m * in_m3 * out_m3) * step_s * step_s;
  const S leak_m3 = derived_.conductance_m3ps_per_Pa * p.bulk_modulus_Pa * step_s;
  const S least_mps = derived_.turns_gradually ? slow_mps(free_N()) : S(0.0);
  const S slope = p.damping_N_s_per_m +
                  effects.slope_N_s_per_m(speed_mps, least_mps, derived_.most_arrest_kg_per_s);
  constexpr double kSquare = limits::kRateStep * limits::kRateStep;
  const auto place = (room_m > travel_m) & (derived_.steady_rate * step_s <= S(limits::kRateStep));
  const auto pressure =
      (low_Pa > S(limits::kLowPressure_Pa)) & (high_Pa < S(limits::kHighPressure_Pa));
  const auto drop =
      (drop_Pa > S(limits::kSmoothDrop_Pa)) & (flow_rate * flow_rate < allowed * allowed * drop_Pa);
  // less than the lower pressure can change within the step
  const S to_spare = S(0.5) * low_Pa * small_m3;
  const S largest_Pa = max(high_Pa, p.supply_pressure_Pa);
  const auto change = (flow_rate * flow_rate * largest_Pa < to_spare * to_spare) &
                      (most_m2 * speed_mps * p.bulk_modulus_Pa * step_s < to_spare);
  const auto stiff = (stiffness < S(kSquare) * derived_.mass_kg * in_m3 * out_m3) &
                     (slope * step_s <= S(limits::kRateStep) * derived_.mass_kg);
  const auto leak = (leak_m3 <= S(limits::kRateStep) * small_m3) & (leak_m3 * high_Pa <= to_spare);
  const auto free = spool_reach_mps(u_V) < derived_.spool_limit_mps;
  return ((place & pressure) & (drop & stiff)) & ((change & leak) & free);
}

/// The fastest that the spool can become within the step.
template <class S, class Design>
S FourWayCylinder<S, Design>::spool_reach_mps(const S& u_V) const {
  const S rate =
      derived_.kv_wv2 * u_V - derived_.two_zeta_wv * state.spool_mps - derived_.wv2 * state.spool_m;
  const S reach_mps = abs(state.spool_mps) + abs(rate) * S(derived_.step_s);
  if constexpr (Design::kEqualSides) {
    return reach_mps;
  } else {
    const S lag_mps = derived_.lag_rate * abs(derived_.valve_gain_m_per_V * u_V - state.spool_m);
    return select(derived_.lag_rate > S(0.0), lag_mps, reach_mps);
  }
}

template <class S, class Design>
void FourWayCylinder<S, Design>::step(const S& u_V) {
  drive_V_ = limits::known_V(u_V);
  drive_V_ = effects.command_V(drive_V_, [&] { return motion(state); });
  const S drive_V = drive_V_;
  if (effects.friction_varies()) {
    effects.weigh_friction([&] { return motion(state); });
    take_contact();
  }
  const auto whole = ordinary(drive_V);
  S turned = 1.0;
  if (derived_.brakes) {
    const S step_per_kg = S(derived_.step_s) * derived_.inverse_mass;
    const auto turns = turns_within(state.v_mps, free_N(), derived_.contact, step_per_kg);
    turned = select(turns, S(kTurnDivisions), turned);
  }
  if (derived_.yields) {
    turned =
        max(turned,
            effects.turn_parts({state.v_mps, free_N(), derived_.inverse_mass, S(derived_.step_s)}));
  }
  const S once_kg_per_s = derived_.mass_kg * S(1.0 / derived_.step_s);
  arrest_kg_per_s_ = once_kg_per_s;
  if (all(whole) && all(turned <= S(1.0))) {
    if (effects.any()) {
      integrate<false, true>(drive_V, S(derived_.step_s));
    } else {
      integrate<false, false>(drive_V, S(derived_.step_s));
    }
    effects.end_step([&] { return motion(state); }, derived_.step_s);
    return;
  }
  const bool at_limits = !all(whole);
  const S parts = at_limits ? max(turned, select(whole, S(1.0), divisions(drive_V))) : turned;
  const S part_s = S(derived_.step_s) / parts;
  arrest_kg_per_s_ = once_kg_per_s * parts;
  const int most = static_cast<int>(reduce_max(parts));
  for (int i = 0; i < most; ++i) {
    const S length_s = select(S(static_cast<double>(i)) < parts, part_s, S(0.0));
    if (at_limits) {
      integrate<true, true>(drive_V, length_s);
    } else {
      integrate<false, true>(drive_V, length_s);
    }
  }
  effects.end_step([&] { return motion(state); }, derived_.step_s);
}

template <class S, class Design>
template <bool kLimits, bool kEffects>
PLANT_SIM_WHOLE void FourWayCylinder<S, Design>::integrate(const S& u_V, const S& step_s) {
  const S from_y_m = state.y_m;
  const auto coupled_rate = [&](const State& x, const S& pull_mps2) {
    return rate<kLimits, kEffects>(x, u_V, from_y_m, pull_mps2);
  };
  if (kEffects && effects.coupled()) {
    state = coupled_step(effects, state, step_s, derived_.disturbed.second_per_kg * disturbance_N,
                         coupled_rate);
  } else {
    state = runge_kutta_step(
        state, step_s, [&](const State& x) { return rate<kLimits, kEffects>(x, u_V, from_y_m); });
  }
  if constexpr (kLimits) {
    const S speed_mps = state.v_mps;
    keep_within_limits();
    if (effects.coupled()) effects.stop_driven(speed_mps - state.v_mps);
  }
  if constexpr (kEffects) {
    const S most_mps = derived_.spool_limit_mps;
    state.spool_mps = clamp(state.spool_mps, -most_mps, most_mps);
    effects.accept(state.y_m - from_y_m, state.v_mps);
  }
}

/// Number of parts of a step, fine enough for the fastest of spool, damping, oil column and
/// orifice.
template <class S, class Design>
S FourWayCylinder<S, Design>::divisions(const S& u_V) const {
  const Parameters& p = parameters;
  const State& x = state;
  const S step_s = derived_.step_s;
  const auto [in_m3, out_m3] = volumes(x.y_m);
  const S least = limits::kSmoothDrop_Pa;
  const S supply_Pa =
      min(abs(p.supply_pressure_Pa - x.in_Pa), abs(p.supply_pressure_Pa - x.out_Pa));
  const S return_Pa =
      min(abs(x.in_Pa - p.return_pressure_Pa), abs(x.out_Pa - p.return_pressure_Pa));
  const S drop_Pa = max(min(supply_Pa, return_Pa), least);
  // the cubic of root() is up to 5/2 times as steep as the square root at its end
  const S orifice_rate = S(1.25) * derived_.most_orifice * reach_m(u_V) * p.bulk_modulus_Pa /
                         (min(in_m3, out_m3) * sqrt(drop_Pa));
  const S in_m2 = in_side().area_m2;
  const S out_m2 = out_side().area_m2;
  const S oil_N_per_m =
      Design::kEqualSides ? in_m2 * in_m2 * p.bulk_modulus_Pa * (S(1.0) / in_m3 + S(1.0) / out_m3)
                          : p.bulk_modulus_Pa * (in_m2 * in_m2 / in_m3 + out_m2 * out_m2 / out_m3);
  const S column_rate = sqrt((oil_N_per_m + derived_.stiffness_N_per_m) * derived_.inverse_mass);
  const S leak_rate = derived_.conductance_m3ps_per_Pa * p.bulk_modulus_Pa / min(in_m3, out_m3);
  const S speed_mps = fast_mps();
  const S least_mps = derived_.turns_gradually ? slow_mps(free_N()) : S(0.0);
  const S damping_rate =
      (p.damping_N_s_per_m +
       effects.slope_N_s_per_m(speed_mps, least_mps, derived_.most_arrest_kg_per_s)) *
      derived_.inverse_mass;
  const S fastest =
      max(max(derived_.steady_rate, damping_rate), max(max(orifice_rate, column_rate), leak_rate));
  // the equations have a corner where the spool reaches its limit
  const S least_parts =
      select(spool_reach_mps(u_V) < derived_.spool_limit_mps, S(1.0), S(limits::kCornerDivisions));
  return clamp(ceil(fastest * step_s * S(1.0 / limits::kRateStep)), least_parts,
               S(limits::kMostDivisions));
}

template <class S, class Design>
void FourWayCylinder<S, Design>::keep_within_limits() {
  const S zero = 0.0;
  State& x = state;
  x.y_m = clamp(x.y_m, zero, parameters.stroke_m);
  x.v_mps = clamp(x.v_mps, S(-limits::kSpeed_mps), S(limits::kSpeed_mps));
  x.v_mps = select(x.y_m <= zero, max(x.v_mps, zero), x.v_mps);
  x.v_mps = select(x.y_m >= parameters.stroke_m, min(x.v_mps, zero), x.v_mps);
  x.in_Pa = clamp(x.in_Pa, zero, S(limits::kHighPressure_Pa));
  x.out_Pa = clamp(x.out_Pa, zero, S(limits::kHighPressure_Pa));
  x.spool_m = clamp(x.spool_m, S(-limits::kSpool_m), S(limits::kSpool_m));
  x.spool_mps = clamp(x.spool_mps, S(-limits::kSpool_mps), S(limits::kSpool_mps));
}

}  // namespace plant_sim
