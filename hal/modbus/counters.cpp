#include "hal/modbus/counters.h"

#include <fmt/format.h>
#include <modbus/modbus.h>

namespace hal::modbus {

std::string summary(const Counters& c) {
  const auto times = [](const Histogram& t) {
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
