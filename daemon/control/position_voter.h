// Which of several rod sensors the controller works with.
//
// Each tick every sensor is judged. One is out
//   missing             when the controller needs it now, or for more readings in a row than [loop]
//                       allows
//   stale, frozen, jump when the guard of that kind says so of its reading
//   outvoted            when it is farther than tolerance_m from the middle of all that are in, for
//                       confirm_s, and those are three or more
// but only where another one is in, has a reading and is right itself: with none left nothing
// changes, and the guards do what they are configured for. A rod that stands still freezes every
// reading: a sensor is frozen only where another has seen the rod move.
//
// The first that is in takes over. It stays, until one before it is in again: after return_s of
// right readings, or on readmit(). Bumpless: the controller is given
//
//   y + b,  b = what it was given in the tick before - what the new sensor read then,
//
// and |b| falls by settle_mps. Guards and records have y itself.
//
// Pure: no device, no thread; after construction nothing allocates.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "daemon/control/sensor_watch.h"

namespace monitor::control {

struct RodReading {
  double y_m = std::numeric_limits<double>::quiet_NaN();  ///< NaN: none that can be trusted
  double age_s = 0.0;
  bool called_stale = false;  ///< where the age is not known
};

class PositionVoter {
 public:
  struct Settings {
    double sample_time_s;
    std::int64_t max_missing;  ///< in a row
    double settle_mps;
  };
  /// `guards` from all_guards(). Without [failover] the first is always in charge.
  PositionVoter(const FailoverConfig& config, const std::vector<GuardConfig>& guards,
                const Settings& settings);

  /// Readings of a tick, at most kMaxRods; `command_V`: u - null of the period that ends now;
  /// `controlling`: the controller drives the valve with them.
  void update(std::span<const RodReading> rods, double t_s, double command_V,
              bool controlling) noexcept;
  /// What is right again is in again, as of the next tick.
  void readmit() noexcept { readmit_ = true; }
  /// A motion begins.
  void start() noexcept;

  [[nodiscard]] std::size_t in_charge() const noexcept { return in_charge_; }
  /// With this tick another took over.
  [[nodiscard]] bool changed() const noexcept { return changed_; }
  /// b; what the controller is given besides y.
  [[nodiscard]] double bump_m() const noexcept { return bump_m_; }
  [[nodiscard]] RodFault fault(std::size_t rod) const noexcept { return rods_[rod].fault; }
  /// Of the sensor in charge; null where there is no other, so that the guards watch it themselves.
  [[nodiscard]] const SensorWatch* watch() const noexcept {
    return count_ > 1 ? &rods_[in_charge_].watch : nullptr;
  }
  /// How far the sensors differ. With [failover]: of two that are in, their distance; of more, the
  /// second-farthest from the middle, since one alone will be voted out. Without: the greatest
  /// distance of a spare from the first.
  [[nodiscard]] double difference_m() const noexcept { return difference_m_; }

 private:
  struct Rod {
    SensorWatch watch;
    RodFault fault = RodFault::none;
    double y_m = std::numeric_limits<double>::quiet_NaN();
    double before_m = std::numeric_limits<double>::quiet_NaN();  ///< y of the tick before
    bool seen = false;                                           ///< it has had a reading
    std::int64_t missing = 0;                                    ///< in a row
    std::int64_t against = 0;                                    ///< ticks off the middle in a row
    std::int64_t right = 0;  ///< ticks in a row that it is right while out
  };

  void read(std::span<const RodReading> rods, double t_s, double command_V) noexcept;
  /// Middle and distances of those that are in.
  void compare() noexcept;
  void judge(std::size_t rod, double t_s, bool controlling) noexcept;
  void bring_back(std::size_t rod) noexcept;
  /// Of those that are in and right themselves the first but `rod`; kMaxRods: none.
  [[nodiscard]] std::size_t other(std::size_t rod, bool must_move, double t_s) const noexcept;
  void put_in_charge(std::size_t rod, bool controlling) noexcept;

  FailoverConfig config_;
  Settings settings_;
  std::int64_t confirm_;  ///< ticks
  double return_ticks_;
  std::vector<Rod> rods_;  ///< kMaxRods
  std::size_t count_ = 1;
  std::size_t in_charge_ = 0;
  bool changed_ = false;
  bool readmit_ = false;
  std::size_t voters_ = 0;  ///< in, with a reading
  double middle_m_ = std::numeric_limits<double>::quiet_NaN();
  double difference_m_ = 0.0;
  double bump_m_ = 0.0;
  double given_m_ =
      std::numeric_limits<double>::quiet_NaN();  ///< to the controlling in the tick before
};

}  // namespace monitor::control
