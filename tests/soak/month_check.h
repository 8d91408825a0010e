// Accounts for every message of a run whose devices, clocks and disk fail as planned:
//
//   sequence numbers without a gap; ticks that rise, each missing one stated; times on the grid,
//   late as planned; the wall clock's steps and no other; readings bad and stale when their fault
//   is on and at no other time; each fault's alarm within its time, and no alarm without a fault;
//   counters of health as what was seen
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/sample_t.hpp"
#include "tests/soak/month_plan.h"

namespace soak {

class MonthCheck {
 public:
  MonthCheck(MonthPlan plan, double duration_s, std::int64_t period_ns);

  /// One event of the stream.
  void take(std::string_view channel, const void* data, int size);
  /// Nothing more comes. `report`: read_report().
  void finish(const std::map<std::string, std::int64_t>& report);

  [[nodiscard]] double time_s() const noexcept { return 1e-9 * static_cast<double>(now_ns_); }
  [[nodiscard]] std::int64_t sent() const noexcept;
  [[nodiscard]] std::int64_t samples() const noexcept { return samples_; }
  [[nodiscard]] std::int64_t lost_periods() const noexcept { return lost_periods_; }
  [[nodiscard]] std::int64_t unlogged() const noexcept { return unlogged_; }
  [[nodiscard]] std::int64_t comings() const noexcept { return comings_; }
  [[nodiscard]] const std::vector<std::string>& problems() const noexcept { return problems_; }
  [[nodiscard]] std::int64_t problem_count() const noexcept { return problem_count_; }

 private:
  void sample(const spoolwatch::sample_t& s);
  void alarm(const spoolwatch::alarm_t& a);
  void health(const spoolwatch::health_t& h);
  template <class Message>
  void in_turn(const char* channel, const Message& message);
  void problem(const std::string& what);
  [[nodiscard]] bool explained(const spoolwatch::alarm_t& a) const;
  /// Marks the faults whose alarm this is.
  void see(const std::string& alarm);
  void expect_alarms();

  MonthPlan plan_;
  double duration_s_;
  std::int64_t period_ns_;
  std::map<std::string, std::int64_t, std::less<>> next_seq_;
  std::size_t device_ = 0, late_ = 0, disk_ = 0, step_ = 0;  ///< the first that is not over
  bool device_seen_ = false, disk_seen_ = false;
  std::int64_t now_ns_ = 0;
  std::int64_t utc_offset_us_ = 0;
  std::int64_t samples_ = 0, lost_periods_ = 0, gaps_ = 0;
  std::int64_t last_tick_ = -1;
  std::int64_t comings_ = 0, unlogged_ = 0, repeats_ = 0;
  spoolwatch::health_t last_{};
  std::int64_t problem_count_ = 0;
  std::vector<std::string> problems_;
};

}  // namespace soak
