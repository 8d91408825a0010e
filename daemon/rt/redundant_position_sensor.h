// The rod sensors of a rig: read one after the other, and the one whose reading counts.
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
  /// `spares` may be null; the devices outlive this. More than kMaxSpareRods are not read.
  RedundantPositionSensor(hal::RodSensor& rod, const std::vector<hal::NamedRod>* spares,
                          LoopStats& stats, const control::PositionVoter& voter) noexcept
      : rod_(rod), spares_(spares), stats_(stats), voter_(voter) {}

  /// Reads all and decides which one is in charge; see PositionVoter::update. Returns that one's
  /// reading, with the configured device's word on the valve's command and on the end of a record.
  const hal::Reading& read(const hal::Tick& tick, const Clock& clock, double t_s, double command_V,
                           bool controlling) noexcept;
  /// What each of them read.
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
