// `spoolwatch compare MODEL.toml --live`: the model beside the running rig, a line each second.
#pragma once

#include <string>

#include "plant_sim/model_file.h"

namespace workbench::live {

struct LiveCompareOptions {
  std::string url, prefix;
  double observer_per_s = 0.0;
  double duration_s = 0.0;  ///< 0: until a signal
  bool json = false;        ///< one object a line
};

/// Writes to standard output until the end. Throws config::schema::Error.
void watch(const plant_sim::ModelFile& model, const LiveCompareOptions& options);

}  // namespace workbench::live
