#include "workbench/serve/lane.h"

#include <algorithm>
#include <iostream>

namespace workbench::serve {

Lane::Lane() : thread_([this] { run(); }) {}

void Lane::end() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    std::erase_if(waiting_, [](const Entry& entry) { return !entry.kept; });
  }
  wakes_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void Lane::post(Work work) { add({std::move(work)}); }

void Lane::post_kept(Work work) { add({.work = std::move(work), .kept = true}); }

void Lane::add(Entry entry) {
  {
    const std::lock_guard lock(mutex_);
    if (ends_) return;
    waiting_.push_back(std::move(entry));
  }
  wakes_.notify_one();
}

void Lane::post_latest(Work work, Work dropped) {
  Work superseded;
  {
    const std::lock_guard lock(mutex_);
    if (ends_) return;
    const auto before = std::find_if(waiting_.begin(), waiting_.end(),
                                     [](const Entry& entry) { return entry.dropped != nullptr; });
    if (before != waiting_.end()) {
      superseded = std::move(before->dropped);
      waiting_.erase(before);
    }
    waiting_.push_back({std::move(work), std::move(dropped)});
  }
  wakes_.notify_one();
  if (superseded) superseded();
}

std::size_t Lane::waiting() const {
  const std::lock_guard lock(mutex_);
  return waiting_.size();
}

void Lane::run() {
  while (true) {
    Work work;
    {
      std::unique_lock lock(mutex_);
      wakes_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      work = std::move(waiting_.front().work);
      waiting_.pop_front();
    }
    try {
      work();
    } catch (const std::exception& error) {
      std::cerr << "spoolwatch serve: a task has failed: " << error.what() << '\n';
    } catch (...) {
      std::cerr << "spoolwatch serve: a task has failed\n";
    }
  }
}

}  // namespace workbench::serve
