// The opened devices and the checked configuration, before the first period of a run.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "daemon/control/guard_config.h"
#include "daemon/control/reference.h"
#include "daemon/daemon_config.h"
#include "daemon/detection_config.h"

namespace monitor {

/// The opened devices and the checked configuration; nothing has been written to a device yet.
struct PreparedSession {
  double sample_time_s;
  hal::OpenContext opening;
  hal::Devices devices;
  std::unique_ptr<control::Reference> reference;
  std::uint64_t hash;
  DetectionConfig detection;
  std::vector<control::GuardConfig> guards;
  std::string never_arms;  ///< why the rig cannot be armed; empty: it can
};

/// Without `absent`: opens the devices exclusively for a run. With `absent`: for inspection; stores
/// the message about an unreachable device there and continues.
[[nodiscard]] PreparedSession prepare(DaemonConfig& config, std::string* absent);

}  // namespace monitor
