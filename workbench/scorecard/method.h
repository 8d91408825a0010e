// A method of fault detection as a row of the scorecard: a name, and the part of a daemon's
// configuration that makes up a pipeline. Bands without limits are learned, as by `spoolwatch
// calibrate`, from a healthy record of the motion that the method is then tried on.
//
// TOML: name, what, false_alarm_time_s, and [[estimator]], [[band]], ... of a daemon's
// configuration.
#pragma once

#include <string>

#include "estimator/fdi/pipeline.h"
#include "workbench/scorecard/stand.h"

namespace workbench::scorecard {

struct Method {
  std::string name;
  std::string what;
  double false_alarm_time_s = 86400.0;  ///< of each learned band, aimed at
  estimator::fdi::PipelineConfig pipeline;
  std::string file;
  std::string text;  ///< as it is in effect: what results depend on

  void visit(config::schema::Visitor& v);
};

/// A file, or the name of a shipped method. Throws config::schema::Error (exit 78).
[[nodiscard]] Method load_method(const std::string& file);

/// The pipeline's configuration with every band learned. Throws config::schema::Error (exit 65)
/// when the record does not do.
[[nodiscard]] estimator::fdi::PipelineConfig train(const Method& method, const Samples& healthy,
                                                   const std::string& record);

}  // namespace workbench::scorecard
