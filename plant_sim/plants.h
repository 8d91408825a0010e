// Every plant there is. Adding one: its file, its include and its line in each_plant.
#pragma once

#include "plant_sim/force_driven_axis.h"
#include "plant_sim/hydraulic_actuator.h"
#include "plant_sim/velocity_servo.h"

namespace plant_sim {

/// Calls f.operator()<Plant<double>>() for each.
template <class F>
void each_plant(F&& f) {
  f.template operator()<HydraulicActuator<double>>();
  f.template operator()<VelocityServo<double>>();
  f.template operator()<ForceDrivenAxis<double>>();
}

}  // namespace plant_sim
