// The configuration of spoolwatchd as it stands in its TOML file.
//
// Tables: [rig], [loop], [rod], [valve], one for each backend used, [reference] and [controller]
// (only where a valve is driven), [safety], [[guard]], [[estimator]], [[tracker]], [[band]],
// bands_file, [model], [control], [alarms], [evidence], [lcm], [recorder].
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "daemon/control/controller.h"
#include "daemon/control/guard_config.h"
#include "daemon/control/reference.h"
#include "daemon/io/alarm_store.h"
#include "daemon/io/control_socket.h"
#include "daemon/io/evidence.h"
#include "daemon/io/publisher.h"
#include "daemon/io/recorder.h"
#include "daemon/rt/loop.h"
#include "estimator/fdi/pipeline_config.h"
#include "estimator/fdi/tracker/detection_method_kinds.h"
#include "hal/rig.h"

namespace monitor {

namespace tracker = estimator::fdi::tracker;

struct DaemonConfig {
  std::string file;              ///< source, for messages
  std::filesystem::path folder;  ///< base of relative paths
  std::string rig_id = "rig";
  std::string calibration;  ///< file written by commissioning; empty: none
  /// Model of the healthy rig for `spoolwatch promote`; empty: none. The daemon only passes the
  /// name on.
  std::string model;
  rt::LoopConfig loop;
  hal::Rig rig;
  control::ReferenceConfig reference;
  control::ControllerConfig controller;
  control::SafetyConfig safety;
  estimator::fdi::PipelineConfig pipeline{tracker::detection_method_kinds()};
  io::ControlConfig control;
  io::AlarmConfig alarms;
  io::EvidenceConfig evidence;
  io::PublisherConfig lcm;
  io::RecorderConfig recorder;

  void visit(config::schema::Visitor& v);
  /// Everything except access and outputs ([control], [alarms], [evidence], [lcm], [recorder]).
  void visit_what_determines_the_data(config::schema::Visitor& v);
  [[nodiscard]] bool drives_valve() const { return rig.valve().backend != "none"; }
};

/// Reads the file and applies "table.key=value" assignments, whose relative paths refer to the
/// working directory. Throws config::schema::ConfigError, UsageError.
void load(const std::filesystem::path& file, const std::vector<std::string>& assignments,
          DaemonConfig& config);

/// Why the rig may not be armed as configured, in one line; empty: it may. Throws
/// config::schema::Error for a calibration of another rig.
[[nodiscard]] std::string never_arms(DaemonConfig& config);

/// Hash (16 hexadecimal digits) of the wiring: backends and channels of valve and rod sensors,
/// their signs, scales, lines and registers.
[[nodiscard]] std::string wiring(DaemonConfig& config);

/// FNV-1a of every value that determines the data; referenced files count by name only.
[[nodiscard]] std::uint64_t hash(DaemonConfig& config);

/// Markdown: every key of the daemon's configuration and of calibration files, for
/// scripts/reference.
[[nodiscard]] std::string configuration_reference();

}  // namespace monitor
