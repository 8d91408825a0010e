#include "workbench/reproduce/experiment.h"
namespace workbench::reproduce {
std::vector<Row> rig_experiment() { return {}; }
}  // namespace workbench::reproduce
