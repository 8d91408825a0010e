// New limits of the guards on their way to the loop, and what the loop did with them. The main
// thread makes the update and keeps it until the outcome is known; the loop only copies the
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
    applied,
    armed,   ///< refused: they let more pass, and the state is ARMED or RUN
    expired  ///< reached the loop too late
  };

  std::vector<control::Guard> guards;  ///< in the order of control::all_guards
  bool loosens = false;                ///< at least one guard lets more pass
  std::atomic<Outcome> outcome{Outcome::pending};
};

}  // namespace monitor::rt
