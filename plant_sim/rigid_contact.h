// Steps within which a rigid dry friction turns its sign, comes to hold or lets go. The force jumps
// there, and an integration that does not know when is off by the jump times a step.
#pragma once

#include "plant_sim/effects/site.h"
#include "plant_sim/guard.h"
#include "plant_sim/scalar.h"

namespace plant_sim {

/// Parts of such a step.
inline constexpr double kTurnDivisions = 16.0;

/// Change of forces within a step, over what they are or add up to.
inline constexpr double kTurnMargin = 2.0;

/// DryContact::arrest_kg_per_s of a mass whose steps are divided as often as can be.
template <class S>
S most_arrest_kg_per_s(const S& mass_kg, double step_s) {
  return mass_kg * S(limits::kMostDivisions / step_s);
}

/// Speed along the motion, m/s, at the end of a step that friction brakes with `braking_N`, its
/// change doubled: below 0 it may turn. `free_N`: the sum of all other forces; `step_per_kg`: step
/// over mass.
template <class S>
S end_speed_mps(const S& v_mps, const S& free_N, const S& braking_N, const S& step_per_kg) {
  const S along_N = select(v_mps < S(0.0), -free_N, free_N) - braking_N;
  return abs(v_mps) + S(kTurnMargin) * step_per_kg * along_N;
}

/// The least speed, m/s, within a step of a contact that turns gradually.
template <class S>
S least_speed_mps(const S& v_mps, const S& free_N, const effects::ContactLevels<S>& contact,
                  const S& step_per_kg) {
  constexpr double kUnsteady = 0.1;  // share by which forces that cancel may fail to
  const S unsteady_N = S(kUnsteady) * (abs(free_N) + contact.gradual_N);
  const S end_mps = end_speed_mps(v_mps, free_N, contact.gradual_N, step_per_kg);
  const S slower_mps = abs(v_mps) - S(kTurnMargin) * step_per_kg * unsteady_N;
  return max(min(end_mps, slower_mps), S(0.0));
}

/// Mask of the lanes in which the contact may turn within a step.
template <class S>
auto turns_within(const S& v_mps, const S& free_N, const effects::ContactLevels<S>& contact,
                  const S& step_per_kg) {
  constexpr double kRest_mps = 1e-9;  // a rod that is held creeps no faster
  constexpr double kNearlyLoose = 1.25;
  const S ends_mps = end_speed_mps(v_mps, free_N, contact.braking_N, step_per_kg);
  const auto resting = abs(v_mps) <= S(kRest_mps);
  const S lets_go = select(abs(free_N) * S(kNearlyLoose) >= contact.holding_N, S(1.0), S(0.0));
  const S turns = select(resting, lets_go, select(ends_mps <= S(0.0), S(1.0), S(0.0)));
  return (contact.braking_N > S(0.0)) & (turns > S(0.0));
}

}  // namespace plant_sim
