// A backend as configuration sees it: its TOML table, and the devices that it offers by name.
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

/// What every backend is told about the rig when it opens.
struct Opening {
  std::string file;              ///< configuration file, for messages
  std::filesystem::path folder;  ///< relative paths of the file start here
  double sample_time_s = 0.005;  ///< period of the loop
  double null_V = 0.0;           ///< the commanded safe voltage
  double limit_V = kMissing;     ///< greatest distance of a command from null
  bool exclusive = true;         ///< to be driven: no other process may; else only looked at
};

/// What one backend has opened. Names (channels) are the backend's or those of its own table.
struct Offer {
  std::map<std::string, std::shared_ptr<RodSensor>> rods;
  std::shared_ptr<ValveDrive> valve;  ///< null when the backend drives none
  std::map<std::string, std::shared_ptr<Input>> inputs;
  std::map<std::string, std::shared_ptr<Output>> outputs;
  double sample_time_s = kMissing;       ///< period that the device dictates (a record's), else NaN
  bool fast = false;                     ///< as fast as possible: nothing waits for the wall clock
  std::function<std::string()> summary;  ///< one line of counters for people, or none
};

/// Channel of a backend that has one rod sensor.
inline constexpr const char* kRodChannel = "position";

/// How long the valve may keep a command of the law, in s; NaN: for ever.
struct NullTimes {
  double bus_lost_s = kMissing;      ///< the device no longer hears us, but runs
  double process_dead_s = kMissing;  ///< nobody writes any more (SIGKILL, SIGSTOP)
  double latency_s = 0.0;            ///< from a write of the loop to the voltage at the valve
  /// The process stands still (SIGSTOP); NaN: as process_dead_s.
  double process_stopped_s = kMissing;
};

class Backend {
 public:
  virtual ~Backend() = default;
  /// Lists the fields of the backend's own table.
  virtual void visit(config::schema::Visitor& v) = 0;
  /// Opens and checks; throws config::schema::Error, DeviceUnavailable where there is no
  /// device. Writes nothing to a device.
  [[nodiscard]] virtual Offer open(const Opening& opening) const = 0;
  /// Moves nothing real, so that it may be armed without a person (`loop.auto_arm`).
  [[nodiscard]] virtual bool harmless() const noexcept = 0;
  /// Fastest the rod can move under a command held at +-limit_V, NaN when it cannot be said.
  [[nodiscard]] virtual double worst_speed_mps(const Opening& opening, double limit_V) const = 0;
  /// What the valve does by itself when it is left alone.
  [[nodiscard]] virtual NullTimes null_times() const { return {}; }
  /// The valve is there and keeps a command when this process has gone.
  [[nodiscard]] virtual bool outlives_process() const noexcept { return true; }
  /// Lines that `--check` prints: what follows from the table and a person should know.
  [[nodiscard]] virtual std::vector<std::string> notes(const Opening& /*opening*/) const {
    return {};
  }
};

/// `text` as a path, relative ones from the configuration file's folder.
[[nodiscard]] inline std::filesystem::path resolve(const Opening& opening,
                                                   const std::string& text) {
  return opening.folder / text;
}

}  // namespace hal
