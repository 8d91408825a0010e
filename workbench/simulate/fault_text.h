// A fault on the command line: PARAMETER=VALUE@TIME or PARAMETER*FACTOR@TIME, with +RAMP behind it
// for a change that takes its time. All in SI: "supply_pressure_Pa*1.25@15", "friction.coulomb_N
// =200@10+2" (without the space).
#pragma once

#include <string>

#include "plant_sim/schedule.h"

namespace workbench::simulate {

/// Throws config::schema::UsageError when the text is not of that form.
[[nodiscard]] plant_sim::Change parse_fault(const std::string& text);

}  // namespace workbench::simulate
