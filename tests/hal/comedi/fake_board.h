// A board in memory: keeps what was written, gives what the test sets, blocks or fails at will.
#pragma once

#include <condition_variable>
#include <map>
#include <mutex>
#include <vector>

#include "hal/comedi/board.h"

namespace hal::comedi::testing {

class FakeBoard final : public Board {
 public:
  bool write(const BoardChannel&, std::uint32_t code) noexcept override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !stuck_; });
    if (failing_) return false;
    written_.push_back(code);
    return true;
  }
  std::optional<std::uint32_t> read(const BoardChannel& place) noexcept override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !stuck_; });
    ++reads_;
    if (failing_) return std::nullopt;
    return codes_[place.channel];
  }

  void set(unsigned channel, std::uint32_t code) {
    const std::lock_guard lock(mutex_);
    codes_[channel] = code;
  }
  void stick(bool stuck) {
    const std::lock_guard lock(mutex_);
    stuck_ = stuck;
    changed_.notify_all();
  }
  void fail(bool failing) {
    const std::lock_guard lock(mutex_);
    failing_ = failing;
  }
  std::vector<std::uint32_t> written() {
    const std::lock_guard lock(mutex_);
    return written_;
  }
  int reads() {
    const std::lock_guard lock(mutex_);
    return reads_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<unsigned, std::uint32_t> codes_;
  std::vector<std::uint32_t> written_;
  int reads_ = 0;
  bool stuck_ = false;
  bool failing_ = false;
};

}  // namespace hal::comedi::testing
