// The daemon's session in virtual time on clocks that are late and set, and on a disk that fails:
// what spoolwatchd runs, with these two in place of its own.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "daemon/rt/clock.h"
#include "tests/soak/month_plan.h"

namespace soak {

/// A virtual clock that wakes late, and whose wall clock is set, as planned.
class UnevenClock final : public monitor::rt::Clock {
 public:
  explicit UnevenClock(const MonthPlan& plan) noexcept : plan_(plan) {}
  [[nodiscard]] std::int64_t now_ns() const noexcept override { return now_ns_; }
  [[nodiscard]] std::int64_t utc_us() const noexcept override;
  void sleep_until_ns(std::int64_t time_ns) noexcept override;

 private:
  const MonthPlan& plan_;
  std::int64_t now_ns_ = 0;
  std::size_t next_ = 0;
  mutable std::size_t step_ = 0;  ///< steps of the wall clock so far
};

/// Messages of the recorder's files by channel, counted as each file is closed.
struct Logged {
  std::map<std::string, std::int64_t> messages;
  std::int64_t files = 0;
  std::int64_t out_of_turn = 0;  ///< sequence numbers that did not rise
  std::int64_t partial = 0;      ///< files that end within an event
};

struct StandOptions {
  std::filesystem::path config;
  std::vector<std::string> assignments;  ///< table.key=value
  std::string lcm_url;
  std::filesystem::path log;     ///< the recorder's folder
  std::filesystem::path report;  ///< what is logged, and what Logged counted
  double duration_s = 0.0;
};

/// In a child of its own; returns its exit code.
int run_stand(const StandOptions& options, const MonthPlan& plan);

/// What run_stand() has reported: messages by channel, "files", "out_of_turn", "partial", and
/// "unlogged", the messages that the daemon says are not in the log.
std::map<std::string, std::int64_t> read_report(const std::filesystem::path& report);

}  // namespace soak
