// A thread with a small stack and, on request, a real-time priority and a CPU of its own. Signals
// stay with the main thread; only those of a crash are handled here, on a separate signal stack, so
// that the handler that commands null runs even after a stack overflow.
#pragma once

#include <pthread.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>

namespace hal {

struct ThreadOptions {
  int priority = 0;               ///< SCHED_FIFO priority; 0: normal class
  int cpu = -1;                   ///< CPU to pin the thread to; -1: any
  bool priority_required = true;  ///< false: use the normal class if SCHED_FIFO is not permitted
};

/// Sanitizers need larger frames and stacks for their own handlers.
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
inline constexpr std::size_t kThreadStack_bytes = 2 * 1024 * 1024;
#else
inline constexpr std::size_t kThreadStack_bytes = 256 * 1024;
#endif

/// Alternate stack for the signal handlers of one thread.
class SignalStack {
 public:
  /// Installs the stack for the calling thread unless it has one; the thread must end before this
  /// object does.
  void use() noexcept;

 private:
  std::array<std::byte, kThreadStack_bytes / 16> bytes_;
};

class Thread {
 public:
  Thread() = default;
  ~Thread() { stop(); }
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;

  /// Runs `body` once. Returns 0 or an errno, in which case no thread runs.
  int start(const char* name, const ThreadOptions& options, std::function<void()> body);
  /// Calls `body`, which should return within some milliseconds, until stop().
  int start_cyclic(const char* name, const ThreadOptions& options, std::function<void()> body);
  /// Ends a cyclic thread and joins.
  void stop();
  void join();
  /// Returns false when the thread is still running after that time.
  bool join_for(std::chrono::milliseconds time);

 private:
  std::function<void()> body_;
  SignalStack signal_stack_;
  pthread_t handle_{};
  bool running_ = false;
  std::atomic<bool> stop_{false};
};

}  // namespace hal
