// A histogram of times in fixed log-linear buckets, 64 per power of two: quantiles to 1.6 %. One
// thread adds, any thread reads; lock-free.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace hal {

class Histogram {
 public:
  /// Negative times count as 0; those of 2^40 ns (18 minutes) and more in the last bucket.
  void add(std::int64_t time_ns) noexcept {
    const std::uint64_t t = time_ns > 0 ? static_cast<std::uint64_t>(time_ns) : 0;
    bump(buckets_[index(t)]);
    bump(count_);
    if (time_ns > max_ns_.load(std::memory_order_relaxed)) {
      max_ns_.store(time_ns, std::memory_order_relaxed);
    }
  }

  [[nodiscard]] std::uint64_t count() const noexcept {
    return count_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] std::int64_t max_ns() const noexcept {
    return max_ns_.load(std::memory_order_relaxed);
  }

  /// Upper edge of the bucket in which the q-quantile lies (at most the maximum), 0 when empty.
  [[nodiscard]] std::int64_t quantile_ns(double q) const noexcept {
    std::uint64_t total = 0;
    for (const auto& bucket : buckets_) total += bucket.load(std::memory_order_relaxed);
    const double wanted = q * static_cast<double>(total);
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < kBuckets; ++i) {
      const std::uint64_t here = buckets_[i].load(std::memory_order_relaxed);
      below += here;
      if (here > 0 && static_cast<double>(below) >= wanted) {
        return upper_edge(i) < max_ns() ? upper_edge(i) : max_ns();
      }
    }
    return 0;
  }

 private:
  static constexpr unsigned kSubBits = 6;
  static constexpr unsigned kSub = 1U << kSubBits;
  static constexpr unsigned kMaxBits = 40;
  static constexpr std::size_t kBuckets = kSub * (kMaxBits - kSubBits + 1);

  static std::size_t index(std::uint64_t t) noexcept {
    if (t < kSub) return t;
    const auto exponent = static_cast<unsigned>(std::bit_width(t)) - 1U;
    if (exponent >= kMaxBits) return kBuckets - 1;
    return (exponent - kSubBits + 1U) * kSub + ((t >> (exponent - kSubBits)) & (kSub - 1U));
  }
  static std::int64_t upper_edge(std::size_t i) noexcept {
    if (i < kSub) return static_cast<std::int64_t>(i);
    const std::size_t shift = i / kSub - 1U;
    return static_cast<std::int64_t>(((kSub + i % kSub + 1U) << shift) - 1U);
  }
  static void bump(std::atomic<std::uint64_t>& counter) noexcept {
    counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }

  std::array<std::atomic<std::uint64_t>, kBuckets> buckets_{};
  std::atomic<std::uint64_t> count_{0};
  std::atomic<std::int64_t> max_ns_{0};
};

}  // namespace hal
