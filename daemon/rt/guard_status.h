// Active guards, published by the loop. One thread consumes the activations, however
// brief; any thread reads the rest.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "daemon/control/guard_monitor.h"

namespace monitor::rt {

class GuardStatus {
 public:
  /// Publishes the state of all guards after a tick.
  void update(const control::GuardMonitor& monitor) noexcept {
    const auto& guards = monitor.guards();
    std::uint32_t active = 0;
    std::uint32_t rose = 0;
    for (std::size_t i = 0; i < guards.size() && i < control::kMaxGuards; ++i) {
      if (!guards[i].active()) continue;
      active |= 1U << i;
      values_[i].store(guards[i].value(), std::memory_order_relaxed);
    }
    rose = active & ~active_.load(std::memory_order_relaxed);
    active_.store(active, std::memory_order_relaxed);
    if (rose != 0) raised_.fetch_or(rose, std::memory_order_release);
  }

  [[nodiscard]] std::uint32_t active() const noexcept {
    return active_.load(std::memory_order_relaxed);
  }
  /// Guards that have become active since the last call, as a bit mask.
  std::uint32_t take_raised() noexcept { return raised_.exchange(0, std::memory_order_acquire); }
  /// The value that the guard compared with its limit when it was last active.
  [[nodiscard]] double value(std::size_t guard) const noexcept {
    return values_[guard].load(std::memory_order_relaxed);
  }

 private:
  std::atomic<std::uint32_t> active_{0};
  std::atomic<std::uint32_t> raised_{0};
  std::array<std::atomic<double>, control::kMaxGuards> values_{};
};

static_assert(control::kMaxGuards <= 32);

}  // namespace monitor::rt
