// What the loop reads besides the rod: auxiliary inputs, and what they say about moving at all.
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
  /// The list may be null and outlives this. More than kMaxInputs are not read. max_unread: a
  /// switch that was on counts as on while it cannot be read for so many times in a row; blind()
  /// meanwhile.
  AuxiliaryInputs(const std::vector<hal::NamedInput>* inputs, std::int64_t max_unread,
                  LoopStats& stats) noexcept;

  /// Reads all.
  void read(const hal::Tick& tick) noexcept;

  /// Every input of that role is 1, as far as is known; true when there is none.
  [[nodiscard]] bool e_stop_released() const noexcept { return e_stop_released_; }
  [[nodiscard]] bool enabled() const noexcept { return enabled_; }
  /// One of them could not be read this time: nothing but null may be written.
  [[nodiscard]] bool blind() const noexcept { return blind_; }
  /// Of the input valve_command, NaN when there is none.
  [[nodiscard]] double command_V() const noexcept { return command_V_; }
  [[nodiscard]] bool has_command() const noexcept { return has_command_; }
  /// Of the inputs that measure them, each NaN where its reading is not good: the fault detection
  /// takes them for what they were at this tick.
  [[nodiscard]] const config::signals::Pressures& pressures() const noexcept { return pressures_; }

 private:
  /// Whether a switch that reads `good`, `on` counts as on.
  bool counts_as_on(std::size_t input, bool good, bool on) noexcept;
  void take_pressure(hal::InputRole role, const hal::InputReading& reading) noexcept;

  const std::vector<hal::NamedInput>* inputs_;
  std::int64_t max_unread_;
  /// Readings since each switch was last seen on; beyond max_unread_: it is off.
  std::array<std::int64_t, kMaxInputs> since_on_{};
  LoopStats& stats_;
  bool e_stop_released_ = true;
  bool enabled_ = true;
  bool blind_ = false;
  bool has_command_ = false;
  double command_V_ = hal::kMissing;
  config::signals::Pressures pressures_;
};

}  // namespace monitor::rt
