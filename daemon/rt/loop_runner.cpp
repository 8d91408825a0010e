#include "daemon/rt/loop_runner.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

namespace monitor::rt {
namespace {

/// Virtual ticks between two polls of `stop_asked`.
constexpr int kTicksPerPoll = 256;
/// Polling period of the consumer: short against any alarm's delay, cheap in wake-ups.
constexpr std::int64_t kPoll_ns = 10'000'000;
/// A loop that has not ended this long after a stop is stuck in a device call.
constexpr std::chrono::milliseconds kStuck{1000};

/// After the loop has ended, for what is still queued to network and disk.
constexpr std::chrono::milliseconds kDetectorStuck{5000};

void consume(SampleConsumer& consumer, const std::atomic<bool>& loop_ended, std::atomic<bool>& stop,
             std::string& failure) {
  try {
    MonotonicClock clock;
    while (!loop_ended.load(std::memory_order_acquire)) {
      consumer.poll();
      clock.sleep_until_ns(clock.now_ns() + kPoll_ns);
    }
    consumer.finish();
  } catch (const std::exception& e) {
    failure = std::string("detector: ") + e.what();
    stop.store(true, std::memory_order_relaxed);
  }
}

/// Exits without destructors, which would wait for the stuck thread.
[[noreturn]] void leave_stuck_thread(hal::ValveDrive* valve, const char* what) {
  if (valve != nullptr) valve->end_at_null();
  std::fputs(what, stderr);
  std::_Exit(1);
}

}  // namespace

std::string run_virtual(LoopRunner& runner, SampleConsumer& consumer, std::atomic<bool>& stop,
                        const std::function<bool()>& stop_asked) {
  for (int n = 0; runner.step(); ++n) {
    consumer.poll();
    if (n % kTicksPerPoll == 0 && stop_asked()) stop.store(true, std::memory_order_relaxed);
  }
  consumer.finish();
  return {};
}

std::string run_realtime(LoopRunner& runner, SampleConsumer& consumer,
                         const hal::ThreadOptions& loop_thread, std::atomic<bool>& stop,
                         hal::ValveDrive* valve, const std::function<bool()>& wait_stop_asked) {
  std::atomic<bool> loop_ended{false};
  std::string failure;
  hal::Thread detecting;
  hal::Thread looping;
  int error =
      detecting.start("detector", {}, [&] { consume(consumer, loop_ended, stop, failure); });
  if (error == 0) {
    error = looping.start("loop", loop_thread, [&] {
      prepare_loop_thread();
      while (runner.step()) {
      }
      loop_ended.store(true, std::memory_order_release);
    });
  }
  if (error != 0) {
    loop_ended.store(true, std::memory_order_release);
    detecting.join();
    return std::string("cannot start a thread: ") + std::strerror(error);
  }
  while (!loop_ended.load(std::memory_order_acquire)) {
    if (wait_stop_asked()) stop.store(true, std::memory_order_relaxed);
    if (stop.load(std::memory_order_relaxed)) break;
  }
  if (!looping.join_for(kStuck)) {
    leave_stuck_thread(valve, "spoolwatchd: a device does not return: null commanded\n");
  }
  if (!detecting.join_for(kDetectorStuck)) {
    leave_stuck_thread(valve, "spoolwatchd: LCM does not return: the last messages are lost\n");
  }
  return failure;
}

}  // namespace monitor::rt
