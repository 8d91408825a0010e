// Steps within which a rigid dry friction turns its sign, comes to hold or lets go. The force jumps
// there, and an integration that does not know when is off by the jump times a step.
#pragma once

#include "plant_sim/effects/site.h"
#include "plant_sim/scalar.h"

namespace plant_sim {

/// Parts of such a step.
inline constexpr double kTurnDivisions = 16.0;

/// Mask of the lanes in which the contact may turn within a step. `free_N`: the sum of all other
/// forces; `step_per_kg`: step over mass.
template <class S>
auto turns_within(const S& v_mps, const S& free_N, const effects::ContactLevels<S>& contact,
                  const S& step_per_kg) {
  constexpr double kRest_mps = 1e-9;  // a rod that is held creeps no faster
  constexpr double kMargin = 2.0;     // forces change within the step, which may hold ahead
  const S along_N = select(v_mps < S(0.0), -free_N, free_N) - contact.braking_N;
  const S ends_mps = abs(v_mps) + S(kMargin) * step_per_kg * along_N;
  const auto resting = abs(v_mps) <= S(kRest_mps);
  const S lets_go = select(abs(free_N) * S(kMargin) >= contact.holding_N, S(1.0), S(0.0));
  const S turns = select(resting, lets_go, select(ends_mps <= S(0.0), S(1.0), S(0.0)));
  return (contact.braking_N > S(0.0)) & (turns > S(0.0));
}

}  // namespace plant_sim
