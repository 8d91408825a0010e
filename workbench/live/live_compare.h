// `spoolwatch compare MODEL.toml --live`: the model beside the running rig, a line each second.
#pragma once

#include <functional>
#include <string>

#include "plant_sim/model_file.h"

namespace workbench::live {

struct LiveCompareOptions {
  std::string url, prefix;
  double observer_per_s = 0.0;
  bool json = false;  ///< one object a line
  /// Asked about ten times a second.
  std::function<bool()> ended{};
  /// Ended by a person: that no samples came is then no error.
  std::function<bool()> interrupted{};
};

/// Writes to standard output until options.ended(). Throws config::schema::Error.
void watch(const plant_sim::ModelFile& model, const LiveCompareOptions& options);

}  // namespace workbench::live
