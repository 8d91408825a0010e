// Changes of parameters that a simulation ends before.
#pragma once

#include <string>
#include <vector>

#include "plant_sim/change.h"

namespace workbench::simulate {

/// One sentence for each change that begins at end_s or later.
[[nodiscard]] std::vector<std::string> late_changes(const std::vector<plant_sim::Change>& changes,
                                                    double end_s);

}  // namespace workbench::simulate
