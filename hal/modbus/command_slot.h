// Data exchanged between the loop and the polling thread: the newest command one way, the latest
// readings the other. Neither side waits; put() is async-signal-safe.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>

#include "hal/modbus/registers.h"

namespace hal::modbus {

/// A raw command and the time at which the loop issued it.
struct RegisterCommand {
  Bits bits = 0;
  std::int64_t t_ns = 0;  ///< resolution 0.13 ms
};

/// Holds the newest command only. Any thread puts, one thread takes.
class CommandSlot {
 public:
  void put(Bits bits, std::int64_t t_ns) noexcept {
    const std::uint64_t stamp = (static_cast<std::uint64_t>(t_ns) >> kShift) | 1U;
    slot_.store(stamp << 32U | bits);
  }
  [[nodiscard]] bool waiting() const noexcept { return slot_.load() != 0; }
  /// Empties the slot. `now_ns` resolves the wrap of the stored time (three days).
  std::optional<RegisterCommand> take(std::int64_t now_ns) noexcept {
    const std::uint64_t packed = slot_.exchange(0, std::memory_order_acquire);
    if (packed == 0) return std::nullopt;
    const auto now = static_cast<std::uint32_t>(static_cast<std::uint64_t>(now_ns) >> kShift) | 1U;
    const auto ago = static_cast<std::int32_t>(now - static_cast<std::uint32_t>(packed >> 32U));
    return RegisterCommand{static_cast<Bits>(packed),
                           now_ns - (static_cast<std::int64_t>(ago) * (1 << kShift))};
  }

 private:
  static constexpr unsigned kShift = 16;  ///< with the lowest bit always set: steps of 2^17 ns

  std::atomic<std::uint64_t> slot_{0};  ///< stamp and bits; 0: empty
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
};

/// Latest readings, by channel and by block of the register map.
struct RegisterSnapshot {
  std::array<std::int64_t, 16> t_ns{};  ///< time of each block; 0: never
  std::array<double, 64> value{};       ///< SI, of each channel
};

}  // namespace hal::modbus
