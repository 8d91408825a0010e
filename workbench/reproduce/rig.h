// The instruments of the test stand's preset, as its model file assumes them.
#pragma once

#include "workbench/reproduce/thesis_scenarios.h"

namespace workbench::reproduce {

/// 2.5 um encoder, 0.2 um noise, 12-bit D/A of +-10 V.
[[nodiscard]] inline Scenario with_rig_instruments(Scenario scenario) {
  scenario.instruments = {2.5e-6, 0.2e-6, 12, 10.0};
  return scenario;
}

}  // namespace workbench::reproduce
