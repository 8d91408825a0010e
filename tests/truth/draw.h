// Sizes of hidden effects and disturbances, log-uniform within a factor of two of a typical one.
#pragma once

#include <cstddef>
#include <string>

#include "tests/truth/record.h"

namespace truth {

/// Hides an effect in the case: a name of the library, or friction_coulomb, friction_stribeck,
/// friction_presliding; push > 1 asks for a stronger one. On the actuator, an axis or a rod the
/// typical size is what such a rig would have.
void draw_effect(const std::string& name, double push, Case& of, Random& random);
/// A disturbance of the actuator or the rod: a random force, a pulsating supply, a shaking sensor
/// or two of these, by the number. An axis has a random force, a line of force, a shaking sensor.
Outside draw_outside(Kind kind, std::size_t which, Random& random);

}  // namespace truth
