// What the loop needs of hardware: read the rod's position, drive the valve, go to null.
//
// A backend (hal/sim, hal/replay, ...) implements one or both interfaces. Units and signs are those
// of the field, set right once inside the backend: metres, volts, positive command extends.
// Every function here is called from the loop: noexcept, no allocation, no lock, no blocking call.
#pragma once

#include <cstdint>
#include <limits>

namespace hal {

inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

enum class Quality : std::uint8_t { good, uncertain, stale, bad };

/// One point of the loop's time grid.
struct Tick {
  std::int64_t index = 0;       ///< periods since the start of the grid
  std::int64_t nominal_ns = 0;  ///< index times the period
};

struct Reading {
  double y_m = kMissing;        ///< rod position, NaN when there is none
  double command_V = kMissing;  ///< the valve's command as the device sees it, NaN when it does not
  Quality quality = Quality::bad;
  bool saturated = false;  ///< that command was at a limit, as far as the device knows
  bool end = false;        ///< nothing more will come (end of a record), and this is no reading
};

struct Applied {
  double u_V = kMissing;  ///< what the valve was given after resolution and range
  bool good = false;
};

class RodSensor {
 public:
  virtual ~RodSensor() = default;
  virtual Reading read(const Tick& tick) noexcept = 0;
};

class ValveDrive {
 public:
  virtual ~ValveDrive() = default;
  virtual Applied write(double u_V, const Tick& tick) noexcept = 0;
  /// The safe voltage `valve.null_V`. Also called from a crash handler: async-signal-safe.
  virtual Applied go_null() noexcept = 0;
};

}  // namespace hal
