// Traffic counters of a device. The polling thread writes, any thread reads.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>

namespace hal::modbus {

/// A distribution of times in log-linear buckets, 16 to each power of two: quantiles to 6 %.
class RoundTrips {
 public:
  void add(std::int64_t time_ns) noexcept {
    const std::uint64_t t = time_ns > 0 ? static_cast<std::uint64_t>(time_ns) : 0;
    buckets_[index(t)].fetch_add(1, std::memory_order_relaxed);
    if (time_ns > max_ns_.load(std::memory_order_relaxed)) {
      max_ns_.store(time_ns, std::memory_order_relaxed);
    }
  }
  /// Upper edge of the bucket that holds the q-quantile, at most the maximum; 0 when empty.
  [[nodiscard]] std::int64_t quantile_ns(double q) const noexcept;
  [[nodiscard]] std::int64_t max_ns() const noexcept {
    return max_ns_.load(std::memory_order_relaxed);
  }

 private:
  static constexpr unsigned kSubBits = 4;
  static constexpr unsigned kMaxBits = 36;  ///< longer times, over a minute, count as that long
  static constexpr std::size_t kBuckets = (kMaxBits - kSubBits + 1) << kSubBits;

  static std::size_t index(std::uint64_t t) noexcept {
    if (t < (1U << kSubBits)) return t;
    const auto exponent = static_cast<unsigned>(std::bit_width(t)) - 1U;
    if (exponent >= kMaxBits) return kBuckets - 1;
    return ((exponent - kSubBits + 1U) << kSubBits) +
           ((t >> (exponent - kSubBits)) & ((1U << kSubBits) - 1U));
  }

  std::array<std::atomic<std::uint64_t>, kBuckets> buckets_{};
  std::atomic<std::int64_t> max_ns_{0};
};

struct Counters {
  using Count = std::atomic<std::uint64_t>;
  Count transactions{0};           ///< requests that were answered, exceptions included
  Count timeouts{0};               ///< replies missing at the time-out
  Count bad_replies{0};            ///< corrupted, or not matching the request
  Count link_errors{0};            ///< connection refused, closed or reset
  Count exceptions{0};             ///< exception replies of the device
  Count reconnects{0};             ///< connections made again after a loss
  Count expired_commands{0};       ///< too old when due: null was written instead
  Count silences{0};               ///< no command from the loop for too long: null was written
  std::atomic<int> last_error{0};  ///< errno of the last loss or exception, libmodbus's included
  RoundTrips round_trips;
  RoundTrips reactions;  ///< from the measurement of a position to the command it led to, taken
};

/// One line for people: "24000 transactions, round trip p50 ...".
[[nodiscard]] std::string summary(const Counters& counters);

}  // namespace hal::modbus
