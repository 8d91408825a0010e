// Between the loop and the thread that talks to the device: the newest command one way, what was
// read last the other. Nobody ever waits, and a command may be put in a signal handler.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/device.h"
#include "hal/modbus/registers.h"

namespace hal::modbus {

/// A raw command and when the loop gave it.
struct Command {
  Bits bits = 0;
  std::int64_t t_ns = 0;  ///< to 0.13 ms
};

/// Holds the newest command only. Any thread puts, one takes.
class CommandBox {
 public:
  void put(Bits bits, std::int64_t t_ns) noexcept {
    const std::uint64_t stamp = (static_cast<std::uint64_t>(t_ns) >> kShift) | 1U;
    box_.store(stamp << 32U | bits);
  }
  [[nodiscard]] bool waiting() const noexcept { return box_.load() != 0; }
  /// Empties the box. `now_ns` tells which of the times that look alike is meant (three days).
  std::optional<Command> take(std::int64_t now_ns) noexcept {
    const std::uint64_t packed = box_.exchange(0, std::memory_order_acquire);
    if (packed == 0) return std::nullopt;
    const auto now = static_cast<std::uint32_t>(static_cast<std::uint64_t>(now_ns) >> kShift) | 1U;
    const auto ago = static_cast<std::int32_t>(now - static_cast<std::uint32_t>(packed >> 32U));
    return Command{static_cast<Bits>(packed),
                   now_ns - (static_cast<std::int64_t>(ago) * (1 << kShift))};
  }

 private:
  static constexpr unsigned kShift = 16;  ///< with the lowest bit always set: steps of 2^17 ns

  std::atomic<std::uint64_t> box_{0};  ///< stamp and bits; 0: empty
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
};

/// What was read last, by channel and by request of the plan.
struct Snapshot {
  std::array<std::int64_t, 16> t_ns{};  ///< of each block; 0: never
  std::array<double, 64> value{};       ///< SI, of each channel
};

}  // namespace hal::modbus
