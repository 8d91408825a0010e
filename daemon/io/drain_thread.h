// A thread of normal priority that empties a queue every now and then: what writes to disk, behind
// what must not wait.
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
  /// Waits for the call in progress; there is none afterwards.
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
