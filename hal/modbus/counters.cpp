#include "hal/modbus/counters.h"

#include <fmt/format.h>
#include <modbus/modbus.h>

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
  const auto times = [](const RoundTrips& t) {
    const auto us = [&](double q) { return static_cast<double>(t.quantile_ns(q)) * 1e-3; };
    return fmt::format("p50 {:.0f} us  p99 {:.0f} us  p99.9 {:.0f} us  max {:.0f} us", us(0.5),
                       us(0.99), us(0.999), static_cast<double>(t.max_ns()) * 1e-3);
  };
  std::string text =
      std::to_string(c.transactions.load()) + " transactions, round trip " + times(c.round_trips);
  if (c.reactions.max_ns() > 0) text += "; position to command " + times(c.reactions);
  const struct {
    const Counters::Count& count;
    const char* what;
  } rows[] = {{c.timeouts, "timeouts"},
              {c.bad_replies, "bad replies"},
              {c.link_errors, "link errors"},
              {c.exceptions, "exceptions"},
              {c.reconnects, "reconnects"},
              {c.expired_commands, "commands expired"},
              {c.silences, "silences of the loop"}};
  const char* separator = "; ";
  for (const auto& row : rows) {
    text += separator + std::to_string(row.count.load()) + " " + row.what;
    separator = ", ";
  }
  const int error = c.last_error.load(std::memory_order_relaxed);
  if (error != 0) text += std::string("; last error: ") + modbus_strerror(error);
  return text;
}

}  // namespace hal::modbus
