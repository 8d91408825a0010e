// Longest delay of a thread that was due, because a host took its CPU away or load of a higher
// priority ran: a test discounts results from that time.
#pragma once

#include <pthread.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

#include "hal/monotonic.h"

namespace program {

/// A thread on each CPU that is due every millisecond, at the highest priority, so that a daemon
/// that keeps its CPU busy is no stall. Without permission for it nothing counts as a stall.
class MachineStalls {
 public:
  MachineStalls() {
    const long cpus = sysconf(_SC_NPROCESSORS_ONLN);
    for (int cpu = 0; cpu < static_cast<int>(cpus); ++cpu) {
      threads_.emplace_back([this, cpu] { watch(cpu); });
    }
  }
  ~MachineStalls() {
    ended_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  MachineStalls(const MachineStalls&) = delete;
  MachineStalls& operator=(const MachineStalls&) = delete;

  /// Longest delay beyond the millisecond, of those that reach into the time from..to.
  double longest_s(std::int64_t from_ns, std::int64_t to_ns) {
    const std::lock_guard lock(mutex_);
    std::int64_t longest_ns = 0;
    for (const Stall& stall : stalls_) {
      if (stall.begin_ns < to_ns && stall.end_ns > from_ns)
        longest_ns = std::max(longest_ns, stall.end_ns - stall.begin_ns);
    }
    return static_cast<double>(longest_ns) * 1e-9;
  }

 private:
  struct Stall {
    std::int64_t begin_ns, end_ns;
  };

  void watch(int cpu) {
    cpu_set_t only;
    CPU_ZERO(&only);
    CPU_SET(cpu, &only);
    sched_param prompt{};
    prompt.sched_priority = sched_get_priority_max(SCHED_FIFO);
    if (pthread_setaffinity_np(pthread_self(), sizeof only, &only) != 0 ||
        pthread_setschedparam(pthread_self(), SCHED_FIFO, &prompt) != 0) {
      return;
    }
    constexpr std::int64_t kPeriod_ns = 1'000'000;
    while (!ended_) {
      const std::int64_t due_ns = hal::monotonic_ns() + kPeriod_ns;
      std::this_thread::sleep_for(std::chrono::nanoseconds(kPeriod_ns));
      const std::int64_t now_ns = hal::monotonic_ns();
      if (now_ns < due_ns + kPeriod_ns) continue;
      const std::lock_guard lock(mutex_);
      stalls_.push_back({due_ns, now_ns});
    }
  }

  std::atomic<bool> ended_{false};
  std::mutex mutex_;
  std::vector<Stall> stalls_;
  std::vector<std::thread> threads_;
};

}  // namespace program
