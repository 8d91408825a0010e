// The sensor guards (stale, frozen, jump) of one rod sensor; each redundant sensor has its own,
// whether in charge or not.
#pragma once

#include <vector>

#include "daemon/control/failover.h"
#include "daemon/control/guard_monitor.h"

namespace monitor::control {

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

  /// The fault indicated by an active guard.
  [[nodiscard]] RodFault fault() const noexcept;
  /// Whether the reading has stood still under a command for at least half of the time that makes
  /// it frozen, so that it cannot confirm motion.
  [[nodiscard]] bool still(double t_s) const noexcept;
  [[nodiscard]] const std::vector<Watched>& guards() const noexcept { return guards_; }

 private:
  std::vector<Watched> guards_;
  LastReading last_;
};

}  // namespace monitor::control
