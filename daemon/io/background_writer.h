// A thread for small files that nobody may wait for: jobs are done in order, off the threads that
// ask for them. A bounded queue: what does not fit is not done, and counted.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace monitor::io {

class BackgroundWriter {
 public:
  BackgroundWriter();
  /// As finish().
  ~BackgroundWriter();
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;

  /// Any thread; waits for nothing longer than another post(). The job must not throw, and owns
  /// what it uses: whoever posts it may be gone when it is done. False when the queue is full.
  bool post(std::function<void()> job);
  /// Does what is queued, and nothing that comes later.
  void finish();
  [[nodiscard]] std::int64_t dropped() const noexcept { return dropped_; }

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> jobs_;  // under mutex_
  bool stop_ = false;                       // under mutex_
  std::atomic<std::int64_t> dropped_{0};
  std::thread thread_;
};

}  // namespace monitor::io
