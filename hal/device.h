// Device interfaces of the control loop, by role: read the rod's position, drive the valve, go to
// null, read an auxiliary input, set an output.
//
// A backend (hal/sim, hal/replay, ...) implements some of these. Units and signs are those of the
// field, converted once inside the backend: metres, volts, pascals, positive command extends. Times
// are of CLOCK_MONOTONIC. Every function here is called from the loop: noexcept, no allocation, no
// lock, no blocking call; a device that blocks runs its own thread and returns the value it
// read last.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "config/signals/quality.h"

namespace hal {

inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Finite and not bad; devices turn readings bad after too long a stale period.
[[nodiscard]] inline bool trusted(config::signals::Quality quality, double value) noexcept {
  return quality != config::signals::Quality::bad && std::isfinite(value);
}

/// One point of the loop's time grid.
struct Tick {
  std::int64_t index = 0;       ///< periods since the start of the grid
  std::int64_t nominal_ns = 0;  ///< index times the period
};

struct Reading {
  double y_m = kMissing;        ///< rod position; NaN: none
  std::int64_t t_ns = 0;        ///< time of measurement; 0: time of the call
  double command_V = kMissing;  ///< valve command as the device reports it; NaN: not reported
  config::signals::Quality quality = config::signals::Quality::bad;
  bool saturated = false;  ///< the reported command was at a limit
  bool end = false;        ///< end of a record; this is not a reading
};

struct Applied {
  double u_V = kMissing;  ///< voltage after resolution and range
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
  /// Null for good: later writes are null too. Waits at most 0.1 s for the device's confirmation,
  /// because the process may end next; not for use in the loop. Async-signal-safe.
  virtual Applied end_at_null() noexcept { return go_null(); }
};

/// An auxiliary signal: volts, pascals, or 0 and 1 of a switch.
struct InputReading {
  double value = kMissing;  ///< NaN: none
  std::int64_t t_ns = 0;    ///< time of measurement; 0: time of the call
  config::signals::Quality quality = config::signals::Quality::bad;
};

class Input {
 public:
  virtual ~Input() = default;
  virtual InputReading read(const Tick& tick) noexcept = 0;
};

/// A line that is on or off, such as the permit for a watchdog relay.
class Output {
 public:
  virtual ~Output() = default;
  /// False when the device rejected the command.
  virtual bool set(bool on) noexcept = 0;
};

}  // namespace hal
