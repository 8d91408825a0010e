// Queues between the loop and the other threads: samples out, commands in. Both are bounded and
// lock-free with one producer and one consumer; a full queue drops the newest item.
#pragma once

#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <type_traits>

#include "config/signals/sample.h"
#include "daemon/control/arming.h"
#include "daemon/rt/guard_update.h"

namespace monitor::rt {

/// A command to the loop; a command that arrives at or after expires_ns is dropped and counted.
struct LoopCommand {
  /// readmit: rod sensors that are right again may vote again
  enum class Kind : std::uint8_t { event, sine, hold, readmit, guards };
  Kind kind = Kind::event;
  control::Event event = control::Event::disarm;  ///< kind event
  bool at_once = false;                           ///< kind event, start: without blending
  std::uint32_t number = 0;                       ///< identifies the answer; 0: no answer wanted
  double centre_m = 0.0;                          ///< kind sine: the new reference signal
  double amplitude_m = 0.0;
  double frequency_Hz = 0.0;
  GuardUpdate* guards = nullptr;  ///< kind guards; its outcome is the answer
  std::int64_t expires_ns = 0;    ///< on the loop's clock
};
static_assert(std::is_trivially_copyable_v<LoopCommand>);

/// Ten seconds of a 200 Hz loop.
using SampleQueue =
    boost::lockfree::spsc_queue<config::signals::Sample, boost::lockfree::capacity<2000>>;
using CommandQueue = boost::lockfree::spsc_queue<LoopCommand, boost::lockfree::capacity<32>>;

}  // namespace monitor::rt
