#include "workbench/simulate/late_changes.h"

#include <fmt/format.h>

namespace workbench::simulate {

std::vector<std::string> late_changes(const std::vector<plant_sim::Change>& changes, double end_s) {
  std::vector<std::string> said;
  for (const plant_sim::Change& change : changes) {
    if (change.at_s < end_s) continue;
    said.push_back(
        fmt::format("the change of {} at {:.6g} s never sets in: the simulation ends at {:.6g} s",
                    change.parameter, change.at_s, end_s));
  }
  return said;
}

}  // namespace workbench::simulate
