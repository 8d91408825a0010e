// A method of fault detection as a row of the scorecard: a name, and the part of a daemon's
// configuration that makes up a pipeline. Bands without limits are learned, as by `spoolwatch
// calibrate`, from a healthy record of the motion that the method is then tried on.
//
// TOML: name, what, false_alarm_time_s, healthy_share, notices, and [[estimator]], [[band]], ... of
// a daemon's configuration.
#pragma once

#include <string>

#include "estimator/fdi/pipeline.h"
#include "estimator/fdi/tracker/detection_method_kinds.h"
#include "workbench/scorecard/simulated_records.h"
#include "workbench/train/learn.h"

namespace workbench::scorecard {

namespace tracker = estimator::fdi::tracker;

struct Method {
  std::string name;
  std::string what;
  double false_alarm_time_s = 86400.0;  ///< target for each learned band
  double healthy_share =
      1.0;  ///< part of the plan's hours without a fault, where a method takes long
  std::vector<std::string> notices;  ///< alarms that are no faults, and are not counted
  estimator::fdi::PipelineConfig pipeline{tracker::detection_method_kinds()};
  std::string file;
  std::string text;  ///< as it is in effect: what results depend on

  void visit(config::schema::Visitor& v);
};

/// A file, or the name of a shipped method. Throws config::schema::ConfigError.
[[nodiscard]] Method load_method(const std::string& file);

/// Records of one motion to learn from.
struct Lessons {
  config::record::Record healthy;
  std::vector<train::Teaching> faults;
};
[[nodiscard]] Lessons lessons(const Bench& bench, const Motion& motion, std::uint64_t seed,
                              bool with_faults);

/// True when the method learns to distinguish faults.
[[nodiscard]] bool needs_faults(const Method& method);

/// The pipeline's configuration with all that is learned in it. Throws config::schema::Error (exit
/// 65) when the records do not do.
[[nodiscard]] estimator::fdi::PipelineConfig learn(const Method& method, const Lessons& lessons);

}  // namespace workbench::scorecard
