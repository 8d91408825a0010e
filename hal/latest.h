// Hands the newest value from one writer thread to one reader thread, wait-free on both sides.
//
// Three slots: the writer fills its own and exchanges it with the middle one, the reader exchanges
// its own with the middle one when that is fresh. Neither waits, and no value is ever torn.
#pragma once

#include <array>
#include <atomic>
#include <type_traits>

namespace hal {

template <class T>
class Latest {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  explicit Latest(const T& first = T()) noexcept { slots_.fill(first); }

  /// Writer only.
  void put(const T& value) noexcept {
    slots_[back_] = value;
    back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex;
  }

  /// Reader only. Stays valid and unchanged until the next call.
  const T& get() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) != 0) {
      front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    }
    return slots_[front_];
  }

 private:
  static constexpr unsigned kFresh = 4;
  static constexpr unsigned kIndex = 3;

  std::array<T, 3> slots_;
  unsigned back_ = 0;   ///< the writer's
  unsigned front_ = 1;  ///< the reader's
  std::atomic<unsigned> middle_{2};
};

}  // namespace hal
