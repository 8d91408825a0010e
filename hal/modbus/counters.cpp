#include "hal/modbus/counters.h"

#include <modbus/modbus.h>

#include <cstdio>

namespace hal::modbus {

std::int64_t RoundTrips::quantile_ns(double q) const noexcept {
  std::uint64_t total = 0;
  for (const auto& bucket : buckets_) total += bucket.load(std::memory_order_relaxed);
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < kBuckets; ++i) {
    const std::uint64_t here = buckets_[i].load(std::memory_order_relaxed);
    below += here;
    if (here == 0 || static_cast<double>(below) < q * static_cast<double>(total)) continue;
    constexpr std::size_t kSub = std::size_t{1} << kSubBits;
    const std::size_t shift = i < kSub ? 0 : i / kSub - 1;
    const std::size_t top = i < kSub ? i : kSub + i % kSub;
    const auto edge = static_cast<std::int64_t>(((top + 1) << shift) - 1);
    return edge < max_ns() ? edge : max_ns();
  }
  return 0;
}

std::string summary(const Counters& c) {
  const auto n = [](const Counters::Count& count) {
    return static_cast<unsigned long long>(count.load(std::memory_order_relaxed));
  };
  const auto us = [&](double q) {
    return static_cast<double>(c.round_trips.quantile_ns(q)) * 1e-3;
  };
  char line[320];
  std::snprintf(line, sizeof line,
                "%llu transactions, round trip p50 %.0f us  p99 %.0f us  p99.9 %.0f us  max %.0f "
                "us; %llu timeouts, %llu bad replies, %llu link errors, %llu exceptions, %llu "
                "reconnects, %llu commands expired, %llu silences of the loop",
                n(c.transactions), us(0.5), us(0.99), us(0.999),
                static_cast<double>(c.round_trips.max_ns()) * 1e-3, n(c.timeouts), n(c.bad_replies),
                n(c.link_errors), n(c.exceptions), n(c.reconnects), n(c.expired_commands),
                n(c.silences));
  std::string text = line;
  const int error = c.last_error.load(std::memory_order_relaxed);
  if (error != 0) text += std::string("; last error: ") + modbus_strerror(error);
  return text;
}

}  // namespace hal::modbus
