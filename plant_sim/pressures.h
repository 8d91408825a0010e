// The pressures that a plant has, as transducers without error would show them: at the valve's
// inlet and in both chambers. Not a number: the plant has no such pressure.
#pragma once

#include <limits>

namespace plant_sim {

/// T: a double, or lanes.
template <class T>
struct PressuresOf {
  T supply_Pa;  ///< at the valve's inlet: what effects such as supply_droop leave of the supply
  T in_Pa;      ///< of the chamber that extends the rod
  T out_Pa;     ///< of the chamber that retracts it
};

using Pressures = PressuresOf<double>;

/// Of a plant template over S; not numbers where it has none.
template <class S, class Model>
PressuresOf<S> pressures_of(const Model& model) {
  if constexpr (requires { model.pressures(); }) {
    return model.pressures();
  } else {
    const S none = std::numeric_limits<double>::quiet_NaN();
    return {none, none, none};
  }
}

}  // namespace plant_sim
