// Every effect there is, in the order in which those of one site act (the command's way through
// the valve from top to bottom). Adding an effect: its file, its include and its name in this list.
#pragma once

#include "plant_sim/effects/acceleration_limit.h"
#include "plant_sim/effects/backlash.h"
#include "plant_sim/effects/coupled_slaves.h"
#include "plant_sim/effects/deadband.h"
#include "plant_sim/effects/drive_lag.h"
#include "plant_sim/effects/drive_saturation.h"
#include "plant_sim/effects/effect_set.h"
#include "plant_sim/effects/encoder_eccentricity.h"
#include "plant_sim/effects/entrained_air.h"
#include "plant_sim/effects/external_leakage.h"
#include "plant_sim/effects/flow_asymmetry.h"
#include "plant_sim/effects/flow_saturation.h"
#include "plant_sim/effects/force_ripple.h"
#include "plant_sim/effects/friction.h"
#include "plant_sim/effects/internal_leakage.h"
#include "plant_sim/effects/lap_leakage.h"
#include "plant_sim/effects/load_force.h"
#include "plant_sim/effects/load_spring.h"
#include "plant_sim/effects/null_bias.h"
#include "plant_sim/effects/quadratic_damping.h"
#include "plant_sim/effects/second_mass.h"
#include "plant_sim/effects/second_order_lag.h"
#include "plant_sim/effects/spool_rate_limit.h"
#include "plant_sim/effects/supply_droop.h"
#include "plant_sim/effects/transport_delay.h"
#include "plant_sim/effects/underlap.h"
#include "plant_sim/effects/valve_hysteresis.h"

namespace plant_sim::effects {

template <class S>
using Effects = EffectSet<S,                  //
                          TransportDelay,     //
                          NullBias,           //
                          ValveHysteresis,    //
                          AccelerationLimit,  //
                          DriveSaturation,    //
                          DriveLag,           //
                          SecondOrderLag,     //
                          SpoolRateLimit,     //
                          Deadband,           //
                          FlowAsymmetry,      //
                          Underlap,           //
                          LapLeakage,         //
                          FlowSaturation,     //
                          SupplyDroop,        //
                          InternalLeakage,    //
                          ExternalLeakage,    //
                          EntrainedAir,       //
                          Friction,           //
                          QuadraticDamping,   //
                          LoadSpring,         //
                          LoadForce,          //
                          ForceRipple,        //
                          CoupledSlaves,      //
                          SecondMass,         //
                          Backlash,           //
                          EncoderEccentricity>;

}  // namespace plant_sim::effects
