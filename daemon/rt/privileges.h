// Real-time privileges: SCHED_FIFO, a core, locked memory, no deep idle states. Asked for before
// anything starts; what was got is said in words, for the log and for health.
#pragma once

#include <string>

#include "daemon/rt/loop.h"
#include "daemon/rt/thread.h"

namespace monitor::rt {

struct Grant {
  ThreadOptions loop_thread;  ///< what the loop's thread may be given
  std::string text;           ///< "SCHED_FIFO 80; memory locked; ..."
};

/// At the very start of the process: small stacks for every thread, one heap arena, so that locked
/// memory stays small.
void keep_memory_small() noexcept;

/// Asks for what `[loop] privileges, priority, cpu` say. Throws config::schema::RunError when
/// required and not got. Locks all memory mapped so far and, as it is touched, all that follows.
[[nodiscard]] Grant ask_privileges(const LoopConfig& config);

/// Touches the stack that the loop will use and asks for prompt timers; on the loop's own thread.
void prepare_loop_thread() noexcept;

}  // namespace monitor::rt
