// A thread of normal priority that periodically drains a queue to disk, so that producers never
// block.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace monitor::io {

class DrainThread {
 public:
  DrainThread() = default;
  ~DrainThread() { stop(); }
  DrainThread(const DrainThread&) = delete;
  DrainThread& operator=(const DrainThread&) = delete;

  /// Calls `drain` every 50 ms, with all signals blocked.
  void start(std::function<void()> drain);
  /// Waits for the call in progress; `drain` is not called afterwards.
  void stop();

 private:
  void run();

  std::function<void()> drain_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stop_ = false;  ///< under mutex_
  std::thread thread_;
};

}  // namespace monitor::io
