// Two models side by side: only what differs.
#pragma once

#include <string>
#include <vector>

#include "plant_sim/model_file.h"

namespace workbench::serve {

struct ModelDifference {
  std::string name;         ///< "mass_kg", "friction.coulomb_N", "plant", "motion"
  std::string here, there;  ///< in words, as the axis that is printed; "-": it has none
};

/// In the order of `here`, then what only `there` has. An effect that is absent has no
/// parameters, and one without influence none that differ.
[[nodiscard]] std::vector<ModelDifference> differences(const plant_sim::ModelFile& here,
                                                       const plant_sim::ModelFile& there);

}  // namespace workbench::serve
