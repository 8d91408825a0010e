// One step of a plant whose moving part carries a second mass (effects/second_mass.h): both are
// integrated together.
#pragma once

#include "plant_sim/effects/site.h"
#include "plant_sim/guard.h"
#include "plant_sim/runge_kutta.h"
#include "plant_sim/scalar.h"

namespace plant_sim {

template <class State, class S>
struct CoupledState {
  State driven;
  effects::CouplingOffset<S> offset;

  CoupledState moved(const CoupledState& rate, const S& by) const {
    return {driven.moved(rate.driven, by),
            {offset.offset_m + by * rate.offset.offset_m,
             offset.offset_mps + by * rate.offset.offset_mps}};
  }
  friend CoupledState operator+(const CoupledState& a, const CoupledState& b) {
    return a.moved(b, S(1.0));
  }
};

/// A force from outside whose place is not given acts where the sensor is.
inline constexpr double kPlaceOfSensor = -1.0;

/// How a force from outside, against the motion, acts on the two parts.
template <class S>
struct DisturbedParts {
  S driven = 1.0;            ///< share on the driven part
  S second_per_kg = S(0.0);  ///< share on the second mass over that mass
};

/// `place`: 0 on the driven part, 1 on the second mass, or kPlaceOfSensor.
template <class Effects, class S>
DisturbedParts<S> disturbed_parts(const Effects& effects, const S& mass_kg, const S& place) {
  const S least_ratio = 0.02;  // a mass of nothing would be moved without limit: it passes F on
  const S given = select(place < S(0.0), effects.sensor_place(), place);
  const S second = select(effects.coupling_rate_per_s() > S(0.0), given, S(0.0));
  const S ratio = effects.coupled_ratio();
  return {S(1.0) - second * min(S(1.0), ratio / least_ratio),
          second / (max(ratio, least_ratio) * mass_kg)};
}

/// The plant's state after the step; the second mass's is kept by the effects. rate(x, a): the
/// plant's rates while the spring accelerates the driven part by a, m/s2. `disturbed_mps2`: a force
/// from outside against the second mass, over that mass.
template <class Effects, class State, class S, class Rate>
State coupled_step(Effects& effects, const State& x, const S& step_s, const S& disturbed_mps2,
                   Rate&& rate) {
  using Both = CoupledState<State, S>;
  const S share = effects.coupled_ratio();
  const Both end = runge_kutta_step(Both{x, effects.offset()}, step_s, [&](const Both& at) -> Both {
    const S pull_mps2 = effects.pull_mps2(at.offset);
    const State driven = rate(at.driven, share * pull_mps2);
    const S ahead_mps2 = (share - S(1.0)) * pull_mps2 - driven.v_mps - disturbed_mps2;
    return {driven, {at.offset.offset_mps, ahead_mps2}};
  });
  const S most_m = limits::kPosition_m;
  const S most_mps = limits::kSpeed_mps;
  effects.set_offset({clamp(end.offset.offset_m, -most_m, most_m),
                      clamp(end.offset.offset_mps, -most_mps, most_mps)});
  return end.driven;
}

}  // namespace plant_sim
