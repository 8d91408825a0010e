// Pressures of a plant template, without transducer error: at the valve's inlet and in both
// chambers. NaN: the plant has no such pressure. Plant::pressures() gives them as
// config::signals::Pressures.
#pragma once

#include <limits>

namespace plant_sim {

/// T: double or a SIMD vector.
template <class T>
struct PressuresOf {
  T supply_Pa;  ///< at the valve's inlet, after effects such as supply_droop
  T in_Pa;      ///< chamber that extends the rod
  T out_Pa;     ///< chamber that retracts it
};

/// Pressures of a plant template over S; NaN where it has none.
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
