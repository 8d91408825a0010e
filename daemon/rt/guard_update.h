// New limits of the guards on their way to the loop, and what the loop did with them. The main
// thread makes the update and keeps it until the loop has done with it; the loop only copies the
// numbers.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "daemon/control/guard_monitor.h"

namespace monitor::rt {

struct GuardUpdate {
  enum class Outcome : std::uint8_t {
    pending,
    given_up,  ///< by the main thread, before the loop began to take them
    taking,    ///< the loop has begun: what comes of it holds
    applied,
    armed,   ///< refused: they let more pass, and the state is ARMED or RUN
    expired  ///< reached the loop too late
  };

  std::vector<control::Guard> guards;  ///< in the order of control::all_guards
  bool loosens = false;                ///< at least one guard lets more pass
  std::atomic<Outcome> outcome{Outcome::pending};

  /// The loop's claim; false where the main thread has given up, and nothing may change.
  [[nodiscard]] bool begin() noexcept { return claim(Outcome::taking); }
  /// The main thread's claim; false where the loop has begun or ended.
  [[nodiscard]] bool give_up() noexcept { return claim(Outcome::given_up); }
  /// True once the loop holds no pointer to it any more.
  [[nodiscard]] bool ended() const noexcept {
    return outcome.load(std::memory_order_acquire) >= Outcome::applied;
  }

 private:
  bool claim(Outcome by) noexcept {
    Outcome expected = Outcome::pending;
    return outcome.compare_exchange_strong(expected, by, std::memory_order_acq_rel);
  }
};

}  // namespace monitor::rt
