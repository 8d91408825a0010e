// Real-time privileges: SCHED_FIFO, a CPU, locked memory, no deep idle states. Requested before
// anything starts; reports what was granted, for the log and health_t.
#pragma once

#include <string>

#include "daemon/rt/loop.h"
#include "hal/thread.h"

namespace monitor::rt {

struct Grant {
  hal::ThreadOptions loop_thread;  ///< options granted to the loop's thread
  std::string text;                ///< "SCHED_FIFO 80; memory locked; ..."
};

/// Call first in the process: small default stacks and a single heap arena keep the locked memory
/// small.
void keep_memory_small() noexcept;

/// Requests what `[loop] privileges, priority, cpu` ask for. Throws config::schema::RunError when
/// a required privilege is not granted. Locks all memory mapped so far, and later mappings as they
/// are touched.
[[nodiscard]] Grant request_privileges(const LoopConfig& config);

/// Touches the stack that the loop will use and requests exact timers. Call on the loop's thread.
void prepare_loop_thread() noexcept;

}  // namespace monitor::rt
