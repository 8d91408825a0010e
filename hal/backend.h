// Interface of a hardware backend: its TOML table and the devices that it provides by name.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/schema/error.h"
#include "config/schema/visitor.h"
#include "hal/device.h"

namespace hal {

/// Facts about the rig that every backend receives in open().
struct OpenContext {
  std::string file;              ///< configuration file, for messages
  std::filesystem::path folder;  ///< relative paths of the file start here
  double sample_time_s = 0.005;  ///< period of the loop
  double null_V = 0.0;           ///< the commanded safe voltage
  double limit_V = kMissing;     ///< greatest distance of a command from null
  bool exclusive = true;  ///< true: drive the devices, no other process may; false: only read
};

/// Devices that one backend has opened, by channel name.
struct BackendDevices {
  std::map<std::string, std::shared_ptr<RodSensor>> rods;
  std::shared_ptr<ValveDrive> valve;  ///< null when the backend drives none
  std::map<std::string, std::shared_ptr<Input>> inputs;
  std::map<std::string, std::shared_ptr<Output>> outputs;
  double sample_time_s = kMissing;       ///< period that the device dictates (a record's), else NaN
  bool fast = false;                     ///< run as fast as possible, independent of the wall clock
  std::function<std::string()> summary;  ///< one readable line of counters; may be empty
};

/// Channel name in a backend with a single rod sensor.
inline constexpr const char* kRodChannel = "position";

/// Longest time that the valve may hold a command of the controller, in s; NaN: for ever.
struct NullTimes {
  double bus_lost_s = kMissing;      ///< the device runs but receives nothing
  double process_dead_s = kMissing;  ///< the process is gone (SIGKILL)
  double latency_s = 0.0;            ///< from a write of the loop to the voltage at the valve
  /// The process is stopped (SIGSTOP); NaN: as process_dead_s.
  double process_stopped_s = kMissing;
};

class Backend {
 public:
  virtual ~Backend() = default;
  /// Lists the fields of the backend's own table.
  virtual void visit(config::schema::Visitor& v) = 0;
  /// Opens and checks; throws config::schema::Error, DeviceUnavailable where there is no
  /// device. Writes nothing to a device.
  [[nodiscard]] virtual BackendDevices open(const OpenContext& context) const = 0;
  /// Moves nothing real, so that `loop.auto_arm` is allowed.
  [[nodiscard]] virtual bool harmless() const noexcept = 0;
  /// Fastest rod speed under a command held at +-limit_V; NaN when unknown.
  [[nodiscard]] virtual double worst_speed_mps(const OpenContext& context,
                                               double limit_V) const = 0;
  /// Behaviour of the valve when commands stop.
  [[nodiscard]] virtual NullTimes null_times() const { return {}; }
  /// Longest age at which a reading still counts when the device's readings stop without an error.
  [[nodiscard]] virtual double reading_hold_s(const OpenContext& /*context*/) const { return 0.0; }
  /// The valve keeps its last command after this process has ended.
  [[nodiscard]] virtual bool outlives_process() const noexcept { return true; }
  /// Lines that `--check` prints: consequences of the table that an operator should know.
  [[nodiscard]] virtual std::vector<std::string> notes(const OpenContext& /*context*/) const {
    return {};
  }
};

/// `text` as a path; relative paths start from the configuration file's folder.
[[nodiscard]] inline std::filesystem::path resolve(const OpenContext& context,
                                                   const std::string& text) {
  return context.folder / text;
}

}  // namespace hal
