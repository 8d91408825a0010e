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
#include "estimator/fdi/tracker/source_kinds.h"
#include "hal/rig.h"

namespace monitor {

namespace tracker = estimator::fdi::tracker;

struct DaemonConfig {
  std::string file;              ///< where it was read from, for messages
  std::filesystem::path folder;  ///< relative paths in it start here
  std::string rig_id = "rig";
  std::string calibration;  ///< file that commissioning wrote; empty: none
  /// Of the healthy rig's physics, for `spoolwatch promote`; empty: none. The daemon only names it.
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
  /// All of it but who gives orders and what is done with the results ([control],
  /// [alarms], [evidence], [lcm], [recorder]).
  void visit_what_determines_the_data(config::schema::Visitor& v);
  [[nodiscard]] bool drives_valve() const { return rig.valve().backend != "none"; }
};

/// Reads the file and applies "table.key=value" assignments; their relative paths start from the
/// caller's folder. Throws config::schema::ConfigError, UsageError.
void load(const std::filesystem::path& file, const std::vector<std::string>& assignments,
          DaemonConfig& config);

/// Why the rig may not be armed as it is configured, in one line; empty: it may. Throws
/// config::schema::Error for a calibration that does not fit.
[[nodiscard]] std::string never_arms(DaemonConfig& config);

/// What determines sign, size and place of command and reading, in 16 hexadecimal digits: backends
/// and channels of valve and rods, and their signs, scales, lines and registers.
[[nodiscard]] std::string wiring(DaemonConfig& config);

/// FNV-1a of every value that determines the data; files that it names count by name alone.
[[nodiscard]] std::uint64_t hash(DaemonConfig& config);

}  // namespace monitor
