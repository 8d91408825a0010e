// Every plant there is. Adding one: its file, its include and its line in each_plant.
#pragma once

#include "plant_sim/force_driven_axis.h"
#include "plant_sim/hydraulic_actuator.h"
#include "plant_sim/hydraulic_cylinder.h"
#include "plant_sim/velocity_servo.h"

namespace plant_sim {

/// Calls f.operator()<Plant<S>>() for each.
template <class S, class F>
void each_plant(F&& f) {
  f.template operator()<HydraulicActuator<S>>();
  f.template operator()<HydraulicCylinder<S>>();
  f.template operator()<VelocityServo<S>>();
  f.template operator()<ForceDrivenAxis<S>>();
}

}  // namespace plant_sim
