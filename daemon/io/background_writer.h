// Writes small files in the background; callers never block on the disk. Jobs run in order; a full
// queue drops the newest job and counts it.
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
  /// Calls finish().
  ~BackgroundWriter();
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;

  /// Any thread; blocks no longer than another post(). The job must not throw and must own its
  /// data, since it may run after its poster is gone. Returns false when the queue is full.
  bool post(std::function<void()> job);
  /// Runs the queued jobs and rejects later ones.
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
