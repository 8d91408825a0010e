// The guards that watch a reading rather than the motion (stale, frozen, jump), for one of several
// rod sensors: each sensor has its own, whether it is in charge or not.
#pragma once

#include <vector>

#include "daemon/control/failover.h"
#include "daemon/control/guard_monitor.h"

namespace monitor::control {

class SensorWatch {
 public:
  struct Watched {
    std::size_t number;  ///< in `guards`
    Guard guard;
  };

  /// `guards` from all_guards().
  explicit SensorWatch(const std::vector<GuardConfig>& guards);

  /// GuardInputs of a tick with this sensor's y and age.
  void watch(const GuardInputs& inputs, double period_s) noexcept;
  void start(double y_m) noexcept;

  /// What an active guard says is wrong.
  [[nodiscard]] RodFault fault() const noexcept;
  /// It has stood still under a command for at least half of the time that makes it frozen: it is
  /// no witness of motion.
  [[nodiscard]] bool still(double t_s) const noexcept;
  [[nodiscard]] const std::vector<Watched>& guards() const noexcept { return guards_; }

 private:
  std::vector<Watched> guards_;
  LastReading last_;
};

}  // namespace monitor::control
