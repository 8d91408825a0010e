// Whatever way the process ends, null is the last command: on leaving the scope, and from a handler
// of fatal signals.
#pragma once

#include "hal/device.h"

namespace monitor {

/// One at a time; `valve` may be null and must outlive it.
class NullGuard {
 public:
  explicit NullGuard(hal::ValveDrive* valve) noexcept;
  ~NullGuard();
  NullGuard(const NullGuard&) = delete;
  NullGuard& operator=(const NullGuard&) = delete;
};

}  // namespace monitor
