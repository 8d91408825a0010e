// Rod sensors that are out as alarms: source "loop", name rod_ID_out.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "config/signals/sample.h"
#include "daemon/control/failover.h"
#include "estimator/fdi/alarm_book.h"

namespace monitor::detection {

class RodAlarms {
 public:
  /// `rods`: ids, the configured one first.
  RodAlarms(std::vector<std::string> rods, double sample_time_s);

  /// Whether "SOURCE.NAME" or "NAME" may be one of these.
  [[nodiscard]] static bool is_one(std::string_view id) noexcept {
    return id.find("rod_") != std::string_view::npos && id.ends_with("_out");
  }

  /// Sets the alarms as the sample says; `changed` is called for each that came or went.
  void report(const config::signals::Sample& sample, estimator::fdi::AlarmBook& book,
              const std::function<void(const estimator::fdi::Alarm&)>& changed);

 private:
  std::vector<std::string> rods_;
  std::vector<std::string> names_;  ///< of the alarms
  double sample_time_s_;
  std::array<std::uint8_t, control::kMaxRods> published_{};
};

}  // namespace monitor::detection
