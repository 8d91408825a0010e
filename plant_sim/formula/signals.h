// Signals that a formula may see, at any site where the plant has them.
//
//   u_V     command behind the effects of the command   in_Pa, out_Pa  chamber pressures
//   y_m     position                                    q_m3ps         flow of the orifice
//   v_mps   speed                                       a_mps2         acceleration
//   x_m     spool position                              z              memory of the formula
//
// All are those of the instant at which the formula is evaluated, except acceleration and memory:
// they are brought up to date at the end of each integration step, so that a force may depend on
// the acceleration that it causes. A reading, which is taken between steps, sees the motion at the
// end of the last one.
#pragma once

#include <array>
#include <cstddef>

#include "plant_sim/effects/site.h"

namespace plant_sim::formula {

enum Signal : std::size_t {
  kCommand,
  kPosition,
  kSpeed,
  kSpool,
  kInPressure,
  kOutPressure,
  kFlow,
  kAcceleration,
  kMemory,
  kSignals
};

inline constexpr std::array<const char*, kSignals> kSignalNames = {
    "u_V", "y_m", "v_mps", "x_m", "in_Pa", "out_Pa", "q_m3ps", "a_mps2", "z"};

/// Motion of a plant at one instant, as formulas see it; 0 for what the plant does not have.
template <class S>
struct Motion {
  S u_V = 0.0;
  S y_m = 0.0;
  S v_mps = 0.0;
  S x_m = 0.0;
  S in_Pa = 0.0;
  S out_Pa = 0.0;
};

/// The motion with an orifice's flow, acceleration and memory: one value for each Signal.
template <class S>
using Signals = std::array<S, kSignals>;

template <class S>
Signals<S> signals_of(const Motion<S>& motion) {
  return {motion.u_V,    motion.y_m, motion.v_mps, motion.x_m, motion.in_Pa,
          motion.out_Pa, S(0.0),     S(0.0),       S(0.0)};
}

}  // namespace plant_sim::formula
