// What the loop reads besides the rod: spare rod sensors and auxiliary inputs, and what they say
// about moving at all.
#pragma once

#include <vector>

#include "daemon/rt/loop_stats.h"
#include "hal/roles.h"

namespace monitor::rt {

class Surroundings {
 public:
  /// Either list may be null; both outlive this. More than kMaxSpareRods, kMaxInputs are not read.
  Surroundings(const std::vector<hal::NamedRod>* spare_rods,
               const std::vector<hal::NamedInput>* inputs, LoopStats& stats) noexcept;

  /// Reads all; y_m of the main sensor, NaN when it has none.
  void read(const hal::Tick& tick, double y_m) noexcept;

  /// Every input of that role is 1, with a reading to be trusted; true when there is none.
  [[nodiscard]] bool e_stop_released() const noexcept { return e_stop_released_; }
  [[nodiscard]] bool enabled() const noexcept { return enabled_; }
  /// Of the input valve_command, NaN when there is none.
  [[nodiscard]] double command_V() const noexcept { return command_V_; }
  [[nodiscard]] bool has_command() const noexcept { return has_command_; }
  /// Greatest |y - spare| of the spares that have a reading; 0 when it cannot be said.
  [[nodiscard]] double spare_difference_m() const noexcept { return spare_difference_m_; }

 private:
  const std::vector<hal::NamedRod>* spare_rods_;
  const std::vector<hal::NamedInput>* inputs_;
  LoopStats& stats_;
  bool e_stop_released_ = true;
  bool enabled_ = true;
  bool has_command_ = false;
  double command_V_ = hal::kMissing;
  double spare_difference_m_ = 0.0;
};

}  // namespace monitor::rt
