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

  /// Waits for what runs and for what post_kept() was given; any other work that has not begun is
  /// dropped. No work is taken from then on.
  void end();
  /// May be called from any thread.
  void post(Work work);
  /// The same, of work that end() does not drop.
  void post_kept(Work work);
  /// Takes the place of earlier work posted so that has not begun; `dropped` of that work is then
  /// called. From any thread.
  void post_latest(Work work, Work dropped);
  [[nodiscard]] std::size_t waiting() const;

 private:
  struct Entry {
    Work work;
    Work dropped{};  ///< set: only the latest counts
    bool kept = false;
  };
  void add(Entry entry);
  void run();

  mutable std::mutex mutex_;
  std::condition_variable wakes_;
  std::deque<Entry> waiting_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace workbench::serve
