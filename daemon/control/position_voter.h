// Selects the rod sensor that the controller uses among redundant ones.
//
// Each tick every sensor is judged. A sensor is out
//   missing             when the controller needs it now, or for more readings in a row than [loop]
//                       allows
//   stale, frozen, jump when the guard of that kind trips on its reading
//   outvoted            when it is farther than tolerance_m from the middle of all sensors that are
//                       in, for confirm_s, and those are three or more
// but only while another sensor is in with a valid, plausible reading: the last sensor stays in
// charge and the guards act as configured. A rod at rest freezes every reading, so a sensor counts
// as frozen only when another one has seen the rod move.
//
// The first sensor that is in takes over until an earlier one is in again, after return_s of
// plausible readings or on readmit(). The transfer is bumpless: the controller gets
//
//   y + b,  b = controller's previous input - previous reading of the new sensor,
//
// and |b| decays at settle_mps. Guards and records use y itself.
//
// Pure: no device, no thread; no allocation after construction.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "daemon/control/failover.h"
#include "daemon/control/guard_monitor.h"

namespace monitor::control {

/// The sensor guards (stale, frozen, jump) of one rod sensor; each redundant sensor has its own,
/// whether in charge or not.
class SensorWatch {
 public:
  struct Watched {
    std::size_t number;  ///< index in `guards`
    Guard guard;
  };

  /// `guards` from all_guards().
  explicit SensorWatch(const std::vector<GuardConfig>& guards);

  /// `inputs`: with this sensor's y and age.
  void watch(const GuardInputs& inputs, double period_s) noexcept;
  void start(double y_m) noexcept;
  /// Takes the limits of `guards`, in the order of all_guards().
  void take_limits(const std::vector<Guard>& guards) noexcept;

  /// The fault indicated by an active guard.
  [[nodiscard]] RodFault fault() const noexcept;
  /// True when the reading has stood still under a command for at least half of the time that makes
  /// it frozen, so that it cannot confirm motion.
  [[nodiscard]] bool still(double t_s) const noexcept;
  [[nodiscard]] const std::vector<Watched>& guards() const noexcept { return guards_; }

 private:
  std::vector<Watched> guards_;
  LastReading last_;
};

struct RodReading {
  double y_m = std::numeric_limits<double>::quiet_NaN();  ///< NaN: no valid reading
  double age_s = 0.0;
  bool called_stale = false;  ///< flagged stale, when the age is unknown
};

class PositionVoter {
 public:
  struct Settings {
    double sample_time_s;
    std::int64_t max_missing;  ///< in a row
    double settle_mps;
  };
  /// `guards` from all_guards(). Without [failover] the first sensor is always in charge.
  PositionVoter(const FailoverConfig& config, const std::vector<GuardConfig>& guards,
                const Settings& settings);

  /// Processes the readings of a tick, at most kMaxRods. `command_V`: u - null of the previous
  /// period; `controlling`: the controller drives the valve.
  void update(std::span<const RodReading> rods, double t_s, double command_V,
              bool controlling) noexcept;
  /// Readmits sensors whose readings are plausible again, at the next tick.
  void readmit() noexcept { readmit_ = true; }
  /// A motion starts.
  void start() noexcept;
  /// Takes the limits of `guards`, in the order of all_guards().
  void take_limits(const std::vector<Guard>& guards) noexcept;

  [[nodiscard]] std::size_t in_charge() const noexcept { return in_charge_; }
  /// True when another sensor took over in this tick.
  [[nodiscard]] bool changed() const noexcept { return changed_; }
  /// b, the offset added to y for the controller.
  [[nodiscard]] double bump_m() const noexcept { return bump_m_; }
  [[nodiscard]] RodFault fault(std::size_t rod) const noexcept { return rods_[rod].fault; }
  /// The sensor guards of the sensor in charge; null for a single sensor, which the GuardMonitor
  /// watches.
  [[nodiscard]] const SensorWatch* watch() const noexcept {
    return count_ > 1 ? &rods_[in_charge_].watch : nullptr;
  }
  /// Disagreement of the sensors. With [failover]: the distance of two sensors that are in; for
  /// more, the second-largest distance from the middle, since a single outlier is voted out.
  /// Without: the largest distance of a spare sensor from the first.
  [[nodiscard]] double difference_m() const noexcept { return difference_m_; }

 private:
  struct Rod {
    SensorWatch watch;
    RodFault fault = RodFault::none;
    double y_m = std::numeric_limits<double>::quiet_NaN();
    double before_m = std::numeric_limits<double>::quiet_NaN();  ///< y at the previous tick
    bool seen = false;                                           ///< has had a reading
    std::int64_t missing = 0;                                    ///< in a row
    std::int64_t against = 0;                                    ///< ticks in a row off the middle
    std::int64_t right = 0;  ///< ticks in a row with plausible readings while out
  };

  void read(std::span<const RodReading> rods, double t_s, double command_V) noexcept;
  /// Computes the middle and the disagreement of the sensors that are in.
  void compare() noexcept;
  void judge(std::size_t rod, double t_s, bool controlling) noexcept;
  void readmit_if_right(std::size_t rod) noexcept;
  /// The first sensor other than `rod` that is in and plausible; kMaxRods: none.
  [[nodiscard]] std::size_t other(std::size_t rod, bool must_move, double t_s) const noexcept;
  void transfer_to(std::size_t rod, bool controlling) noexcept;

  FailoverConfig config_;
  Settings settings_;
  std::int64_t confirm_;  ///< ticks
  double return_ticks_;
  std::vector<Rod> rods_;  ///< kMaxRods
  std::size_t count_ = 1;
  std::size_t in_charge_ = 0;
  bool changed_ = false;
  bool readmit_ = false;
  std::size_t voters_ = 0;  ///< sensors in with a reading
  double middle_m_ = std::numeric_limits<double>::quiet_NaN();
  double difference_m_ = 0.0;
  double bump_m_ = 0.0;
  double given_m_ =
      std::numeric_limits<double>::quiet_NaN();  ///< controller input of the previous tick
};

}  // namespace monitor::control
