// How long the machine did not run a thread that was due: a host that takes a CPU away, or load of
// a higher priority. What happened meanwhile says nothing of the daemon.
#pragma once

#include <pthread.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "hal/monotonic.h"

namespace program {

/// A thread on each CPU that is due every millisecond, in real time where the machine lets it.
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

  /// The longest time, beyond the millisecond, that one of the threads had to wait so far.
  double longest_s() const { return static_cast<double>(longest_ns_) * 1e-9; }

 private:
  void watch(int cpu) {
    cpu_set_t only;
    CPU_ZERO(&only);
    CPU_SET(cpu, &only);
    pthread_setaffinity_np(pthread_self(), sizeof only, &only);
    sched_param prompt{};
    prompt.sched_priority = 1;  // below the daemon: it may take what it needs
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &prompt);
    constexpr std::int64_t kPeriod_ns = 1'000'000;
    std::int64_t last_ns = hal::monotonic_ns();
    while (!ended_) {
      std::this_thread::sleep_for(std::chrono::nanoseconds(kPeriod_ns));
      const std::int64_t now_ns = hal::monotonic_ns();
      std::int64_t longest_ns = longest_ns_;
      while (now_ns - last_ns - kPeriod_ns > longest_ns &&
             !longest_ns_.compare_exchange_weak(longest_ns, now_ns - last_ns - kPeriod_ns)) {
      }
      last_ns = now_ns;
    }
  }

  std::atomic<bool> ended_{false};
  std::atomic<std::int64_t> longest_ns_{0};
  std::vector<std::thread> threads_;
};

}  // namespace program
