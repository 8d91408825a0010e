// Random faults of everything around the daemon, by a seed: the plant and its devices, the clocks,
// the recorder's disk, and a subscriber that stops to read.
//
//   devices  the supply pressure steps to 0.75 or 1.25 of its own; the reading is missing, frozen,
//            stale or off by 20 mm; the valve ignores commands. One at a time, at least 60 s apart.
//   clocks   wake-ups late by up to 200 ms; the wall clock set by up to two hours, either way
//   disk     full, failing, or taking fifty bytes at a time, for 5 to 300 s
//   peer     reads nothing for up to 0.3 s of real time
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace soak {

struct DeviceFault {
  std::string kind;   ///< of [[sim.trouble]], or "pressure"
  std::string alarm;  ///< that must come
  double from_s, to_s;
  double factor = 1.0;  ///< of the supply pressure
};

struct LateWakeUp {
  std::int64_t at_ns;
  std::int64_t late_ns;
};

/// The wall clock is off by so much from then on.
struct ClockStep {
  std::int64_t at_ns;
  std::int64_t offset_us;
};

enum class DiskTrouble : std::uint8_t { full, failing, short_writes };

struct DiskFault {
  DiskTrouble trouble;
  std::int64_t from_ns, to_ns;
};

struct MonthPlan {
  std::vector<DeviceFault> devices;
  std::vector<LateWakeUp> late;
  std::vector<ClockStep> steps;
  std::vector<DiskFault> disk;

  /// All of them over 200 s before the end.
  MonthPlan(std::uint64_t seed, double duration_s);

  /// [[sim.fault]] and [[sim.trouble]] of the devices' faults.
  [[nodiscard]] std::string as_toml() const;
};

}  // namespace soak
