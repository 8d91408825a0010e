// Thread of a device that may block. Signals other than those of a crash stay with the main thread;
// a real-time priority is requested and used where granted.
#pragma once

#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>
#include <time.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <functional>
#include <utility>

namespace hal {

inline std::int64_t monotonic_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

class DeviceThread {
 public:
  DeviceThread() = default;
  ~DeviceThread() { stop(); }
  DeviceThread(const DeviceThread&) = delete;
  DeviceThread& operator=(const DeviceThread&) = delete;

  /// Calls `body` again and again until stop(); it should return within some milliseconds.
  /// `priority`: of SCHED_FIFO, 0 for the normal class. Returns 0 or an errno.
  int start(const char* name, int priority, std::function<void()> body) {
    body_ = std::move(body);
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    // A crash in here must still find the handler that commands null.
    for (const int crash : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP}) {
      sigdelset(&all, crash);
    }
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const int error = pthread_create(&handle_, nullptr, run, this);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    if (error != 0) return error;
    running_ = true;
    pthread_setname_np(handle_, name);
    if (priority > 0) {
      sched_param parameters{};
      parameters.sched_priority = priority;
      pthread_setschedparam(handle_, SCHED_FIFO, &parameters);
    }
    return 0;
  }

  /// Waits for the body to return.
  void stop() {
    if (!running_) return;
    stop_.store(true, std::memory_order_relaxed);
    pthread_join(handle_, nullptr);
    running_ = false;
  }

 private:
  static void* run(void* self) {
    auto* thread = static_cast<DeviceThread*>(self);
    prctl(PR_SET_TIMERSLACK, 1UL);  // in the normal class a sleep would end 50 us late
    while (!thread->stop_.load(std::memory_order_relaxed)) thread->body_();
    return nullptr;
  }

  std::function<void()> body_;
  pthread_t handle_{};
  bool running_ = false;
  std::atomic<bool> stop_{false};
};

}  // namespace hal
