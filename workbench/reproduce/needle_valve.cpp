#include "workbench/reproduce/experiment.h"
namespace workbench::reproduce {
std::vector<Row> needle_valve() { return {}; }
}  // namespace workbench::reproduce
