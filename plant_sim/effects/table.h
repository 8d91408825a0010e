// Every effect there is, in the order in which those of one site act. Adding an effect: its file,
// its include and its name in this list.
#pragma once

#include "plant_sim/effects/coupled_slaves.h"
#include "plant_sim/effects/deadband.h"
#include "plant_sim/effects/effect_set.h"
#include "plant_sim/effects/friction.h"

namespace plant_sim {

template <class S>
using Effects = EffectSet<S,              //
                          Deadband,       //
                          CoupledSlaves,  //
                          Friction>;

}  // namespace plant_sim
