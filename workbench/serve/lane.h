// A thread that does one thing after the other, so that the network's thread computes nothing. An
// exception ends the one thing alone and is logged.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace workbench::serve {

class Lane {
 public:
  using Work = std::function<void()>;

  Lane();
  ~Lane() { end(); }
  Lane(const Lane&) = delete;
  Lane& operator=(const Lane&) = delete;

  /// Waits for what runs; what has not begun is dropped, now and later.
  void end();
  /// May be called from any thread.
  void post(Work work);
  /// Takes the place of earlier work posted so that has not begun; `dropped` of that work is then
  /// called. From any thread.
  void post_latest(Work work, Work dropped);
  [[nodiscard]] std::size_t waiting() const;

 private:
  struct Entry {
    Work work;
    Work dropped{};  ///< set: only the latest counts
  };
  void run();

  mutable std::mutex mutex_;
  std::condition_variable wakes_;
  std::deque<Entry> waiting_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace workbench::serve
