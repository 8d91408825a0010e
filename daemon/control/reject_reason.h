// Why an order was not carried out, and the loop's answer to one.
#pragma once

#include <cstdint>

#include "daemon/control/arming.h"

namespace monitor::control {

enum class RejectReason : std::uint8_t {
  none,         ///< carried out
  state,        ///< not allowed in the state of the moment
  monitor,      ///< nothing is driven
  expired,      ///< came too late to the loop
  closing,      ///< the daemon ends
  position,     ///< no position to begin from
  enable,       ///< the enable input is not 1
  guard,        ///< an active guard forbids it
  calibration,  ///< devices that move something, and no calibration
};

/// The loop's answer to the order with that number.
struct Answer {
  std::uint32_t number = 0;
  RejectReason reject_reason = RejectReason::none;
  State state = State::disarmed;
  std::uint8_t guard = 0;  ///< of RejectReason::guard
};

/// As one word, for an atomic.
[[nodiscard]] constexpr std::uint64_t pack(const Answer& a) noexcept {
  return (std::uint64_t{a.number} << 32U) | (std::uint64_t{a.guard} << 16U) |
         (static_cast<std::uint64_t>(a.reject_reason) << 8U) | static_cast<std::uint64_t>(a.state);
}

[[nodiscard]] constexpr Answer unpack(std::uint64_t word) noexcept {
  return {static_cast<std::uint32_t>(word >> 32U),
          static_cast<RejectReason>(static_cast<std::uint8_t>(word >> 8U)),
          static_cast<State>(static_cast<std::uint8_t>(word)),
          static_cast<std::uint8_t>(word >> 16U)};
}

}  // namespace monitor::control
