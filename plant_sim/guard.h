// Numerical guards shared by all plants: far beyond physical values, they keep states finite.
#pragma once

#include "plant_sim/scalar.h"

namespace plant_sim::limits {

inline constexpr double kSpeed_mps = 1e3;
inline constexpr double kAxisSpeed_mps = 1e5;  ///< of an axis that may turn: beyond any spindle
inline constexpr double kPosition_m = 1e6;
inline constexpr double kCommand_V = 1e4;
/// A rate times the step up to which RK4 follows; it is stable up to 2.78.
inline constexpr double kRateStep = 1.5;
inline constexpr double kMostDivisions = 64.0;
/// The same for a resonance of little damping: RK4 then bends its frequency by less than 0.1 % and
/// its damping ratio by less than 0.001.
inline constexpr double kResonanceStep = 0.5;

/// The command within the guard; NaN counts as 0 V.
template <class S>
S known_V(const S& u_V) {
  return select(abs(u_V) <= S(kCommand_V), u_V,
                select(u_V > S(0.0), S(kCommand_V), select(u_V < S(0.0), S(-kCommand_V), S(0.0))));
}

}  // namespace plant_sim::limits
