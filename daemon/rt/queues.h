// What passes between the loop and the other threads: samples out, commands in. Both queues are
// bounded and lock-free, one producer and one consumer each; a full queue drops the newest.
#pragma once

#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <type_traits>

#include "config/signals/sample.h"
#include "daemon/control/arming.h"

namespace monitor::rt {

/// An order to the loop; one that arrives at or after expires_ns is dropped and counted.
struct Command {
  /// readmit: rod sensors that were out and are right again may be in again
  enum class Kind : std::uint8_t { event, sine, hold, readmit };
  Kind kind = Kind::event;
  control::Event event = control::Event::disarm;  ///< of kind event
  bool at_once = false;                           ///< of start: without blending
  std::uint32_t number = 0;                       ///< for the answer; 0: none is wanted
  double centre_m = 0.0;                          ///< of kind sine: the new reference signal
  double amplitude_m = 0.0;
  double frequency_Hz = 0.0;
  std::int64_t expires_ns = 0;  ///< on the loop's clock
};
static_assert(std::is_trivially_copyable_v<Command>);

/// Ten seconds of a 200 Hz loop.
using SampleQueue =
    boost::lockfree::spsc_queue<config::signals::Sample, boost::lockfree::capacity<2000>>;
using CommandQueue = boost::lockfree::spsc_queue<Command, boost::lockfree::capacity<32>>;

}  // namespace monitor::rt
