// Why the loop rejected a command, and the answer that carries the reason.
#pragma once

#include <cstdint>

#include "daemon/control/arming.h"

namespace monitor::control {

enum class RejectReason : std::uint8_t {
  none,         ///< executed
  state,        ///< not allowed in the current state
  monitor,      ///< no valve is driven
  expired,      ///< reached the loop too late
  closing,      ///< the daemon is shutting down
  position,     ///< no valid position to start from
  enable,       ///< the enable input is off
  guard,        ///< an active guard forbids it
  calibration,  ///< real devices without a valid calibration
};

/// The loop's answer to the command with that number.
struct CommandAnswer {
  std::uint32_t number = 0;
  RejectReason reject_reason = RejectReason::none;
  ArmingState state = ArmingState::disarmed;
  std::uint8_t guard = 0;  ///< index, for RejectReason::guard
};

/// Packs an answer into one word, for an atomic.
[[nodiscard]] constexpr std::uint64_t pack(const CommandAnswer& a) noexcept {
  return (std::uint64_t{a.number} << 32U) | (std::uint64_t{a.guard} << 16U) |
         (static_cast<std::uint64_t>(a.reject_reason) << 8U) | static_cast<std::uint64_t>(a.state);
}

[[nodiscard]] constexpr CommandAnswer unpack(std::uint64_t word) noexcept {
  return {static_cast<std::uint32_t>(word >> 32U),
          static_cast<RejectReason>(static_cast<std::uint8_t>(word >> 8U)),
          static_cast<ArmingState>(static_cast<std::uint8_t>(word)),
          static_cast<std::uint8_t>(word >> 16U)};
}

}  // namespace monitor::control
