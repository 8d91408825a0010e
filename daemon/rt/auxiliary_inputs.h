// The auxiliary inputs of the loop: interlocks (emergency stop, enable), pressures, valve command.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "config/signals/pressures.h"
#include "daemon/rt/loop_stats.h"
#include "hal/rig.h"

namespace monitor::rt {

class AuxiliaryInputs {
 public:
  /// The list may be null and must outlive this object; at most kMaxInputs are read. A switch that
  /// was on counts as on for up to max_unread failed readings in a row, during which blind() is
  /// true.
  AuxiliaryInputs(const std::vector<hal::NamedInput>* inputs, std::int64_t max_unread,
                  LoopStats& stats) noexcept;

  /// Reads all inputs.
  void read(const hal::Tick& tick) noexcept;

  /// True when every input of that role is on as far as known; true without such inputs.
  [[nodiscard]] bool e_stop_released() const noexcept { return e_stop_released_; }
  /// The trip of an e-stop is that of an input that cannot be read, not of one that reads 0.
  [[nodiscard]] bool e_stop_unread() const noexcept {
    return !e_stop_released_ && !e_stop_pressed_;
  }
  [[nodiscard]] bool enabled() const noexcept { return enabled_; }
  /// A switch could not be read in this tick: only null may be written.
  [[nodiscard]] bool blind() const noexcept { return blind_; }
  /// Reading of the input valve_command, NaN without one.
  [[nodiscard]] double command_V() const noexcept { return command_V_; }
  [[nodiscard]] bool has_command() const noexcept { return has_command_; }
  /// Measured pressures at this tick, NaN where a reading is not good.
  [[nodiscard]] const config::signals::Pressures& pressures() const noexcept { return pressures_; }

 private:
  /// True when a switch with this reading counts as on.
  bool counts_as_on(std::size_t input, bool good, bool on) noexcept;
  void update_pressure(hal::InputRole role, const hal::InputReading& reading) noexcept;

  const std::vector<hal::NamedInput>* inputs_;
  std::int64_t max_unread_;
  /// Readings since each switch was last seen on; off beyond max_unread_.
  std::array<std::int64_t, kMaxInputs> since_on_{};
  LoopStats& stats_;
  bool e_stop_released_ = true;
  bool e_stop_pressed_ = false;  ///< one reads something else than 1
  bool enabled_ = true;
  bool blind_ = false;
  bool has_command_ = false;
  double command_V_ = hal::kMissing;
  config::signals::Pressures pressures_;
};

}  // namespace monitor::rt
