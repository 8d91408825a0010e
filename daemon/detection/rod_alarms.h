// Alarms for rod sensors that the voter has excluded: source "loop", name rod_ID_out.
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
  /// `rods`: sensor ids, the configured one first.
  RodAlarms(std::vector<std::string> rods, double sample_time_s);

  /// Whether "SOURCE.NAME" or "NAME" may name one of these alarms.
  [[nodiscard]] static bool is_one(std::string_view id) noexcept {
    return id.find("rod_") != std::string_view::npos && id.ends_with("_out");
  }

  /// Updates the alarms from the sample; calls `changed` for each alarm that came or went.
  void report(const config::signals::Sample& sample, estimator::fdi::AlarmBook& book,
              const std::function<void(const estimator::fdi::Alarm&)>& changed);

 private:
  std::vector<std::string> rods_;
  std::vector<std::string> names_;  ///< alarm names
  double sample_time_s_;
  std::array<std::uint8_t, control::kMaxRods> published_{};
};

}  // namespace monitor::detection
