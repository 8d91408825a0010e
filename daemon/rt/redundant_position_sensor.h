// The redundant rod sensors of a rig: reads all of them and returns the reading of the one in
// charge.
#pragma once

#include <array>
#include <vector>

#include "config/signals/sample.h"
#include "daemon/control/position_voter.h"
#include "daemon/rt/clock.h"
#include "daemon/rt/loop_stats.h"
#include "hal/rig.h"

namespace monitor::rt {

class RedundantPositionSensor {
 public:
  /// `spares` may be null; the devices must outlive this object. At most kMaxSpareRods are read.
  RedundantPositionSensor(hal::RodSensor& rod, const std::vector<hal::NamedRod>* spares,
                          LoopStats& stats, const control::PositionVoter& voter) noexcept
      : rod_(rod), spares_(spares), stats_(stats), voter_(voter) {}

  /// Reads all sensors and updates the voter (PositionVoter::update). Returns the reading of the
  /// sensor in charge; valve command and end of record are always the configured sensor's.
  const hal::Reading& read(const hal::Tick& tick, const Clock& clock, double t_s, double command_V,
                           bool controlling) noexcept;
  /// Copies all readings into the sample.
  void fill(config::signals::Sample& sample) const noexcept;

  [[nodiscard]] control::PositionVoter& voter() noexcept { return voter_; }
  [[nodiscard]] const control::PositionVoter& voter() const noexcept { return voter_; }

 private:
  void publish(std::int64_t tick) noexcept;

  hal::RodSensor& rod_;
  const std::vector<hal::NamedRod>* spares_;
  LoopStats& stats_;
  control::PositionVoter voter_;
  std::size_t count_ = 1;
  std::array<hal::Reading, control::kMaxRods> readings_{};
  hal::Reading in_charge_;
  std::int64_t since_tick_ = 0;
};

static_assert(config::signals::kMaxRods == control::kMaxRods);

}  // namespace monitor::rt
