// A thread with a small stack, and if asked a real-time priority and a core of its own.
#pragma once

#include <pthread.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <functional>

namespace monitor::rt {

struct ThreadOptions {
  int priority = 0;  ///< of SCHED_FIFO; 0: the scheduler's normal class
  int cpu = -1;      ///< core to be pinned to; -1: any
};

/// What the sanitizers add to each frame, and what their own handlers need, takes more.
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
inline constexpr std::size_t kThreadStack_bytes = 2 * 1024 * 1024;
#else
inline constexpr std::size_t kThreadStack_bytes = 256 * 1024;
#endif

/// Where a thread's signal handlers run, so that they do when its own stack has overflowed.
class SignalStack {
 public:
  /// For the calling thread, unless it has one; it must end before the object does.
  void use() noexcept;

 private:
  std::array<std::byte, kThreadStack_bytes / 16> bytes_;
};

class Thread {
 public:
  Thread() = default;
  ~Thread();  ///< joins
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;

  /// Returns 0, or the errno of what was not granted; then nothing runs.
  int start(const char* name, const ThreadOptions& options, std::function<void()> body);
  void join();
  /// False when it is still running after that time.
  bool join_for(std::chrono::milliseconds time);

 private:
  std::function<void()> body_;
  SignalStack signal_stack_;
  pthread_t handle_{};
  bool running_ = false;
};

}  // namespace monitor::rt
