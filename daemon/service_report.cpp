#include "daemon/service_report.h"

#include <fmt/format.h>

#include "daemon/control/protocol.h"

namespace monitor {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
/// Keep-alives per watchdog time.
constexpr std::int64_t kKeepAlives = 4;

}  // namespace

bool ServiceReport::works() const noexcept {
  return stats_.rod.good.value() >= kGoodCycles &&
         (!drives_ || stats_.valve_good.value() >= kGoodCycles) &&
         stats_.detected_samples.value() >= kGoodCycles;
}

void ServiceReport::poll() {
  const std::int64_t now_ns = clock_.now_ns();
  if (!ready_ && works()) {
    ready_ = true;
    next_line_ns_ = now_ns;
    manager_.ready();
  }
  feed(now_ns);
  send_status(now_ns);
}

void ServiceReport::feed(std::int64_t now_ns) {
  if (manager_.watchdog_ns() == 0 || now_ns - fed_ns_ < manager_.watchdog_ns() / kKeepAlives)
    return;
  const std::int64_t ticks = stats_.ticks.value();
  const std::int64_t detected = stats_.detected_samples.value();
  if (ticks == fed_ticks_ || detected == fed_detected_) return;
  fed_ns_ = now_ns;
  fed_ticks_ = ticks;
  fed_detected_ = detected;
  manager_.alive();
}

void ServiceReport::send_status(std::int64_t now_ns) {
  if (now_ns < next_line_ns_) return;
  next_line_ns_ = now_ns + kSecond_ns;
  std::string line = this->line();
  if (line == last_line_) return;
  manager_.status(line);
  last_line_ = std::move(line);
}

std::string ServiceReport::line() const {
  if (!ready_) return "waiting for the first good cycles";
  const std::string text =
      fmt::format("{}, active alarms: {}, lateness p99.9 {:.2f} ms, lost periods: {}",
                  control::to_string(stats_.state.load(std::memory_order_relaxed)),
                  static_cast<int>(stats_.active_alarms.load(std::memory_order_relaxed)),
                  static_cast<double>(stats_.lateness.quantile_ns(0.999)) * 1e-6,
                  stats_.skipped_periods.value());
  return remark_.empty() ? text : text + "; " + remark_;
}

}  // namespace monitor
