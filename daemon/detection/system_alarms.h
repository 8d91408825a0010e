// Alarms about the daemon itself: failed publishing, recording and evidence, guards, rod sensors.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "config/signals/sample.h"
#include "daemon/control/failover.h"
#include "daemon/control/guard_config.h"
#include "daemon/io/evidence.h"
#include "daemon/io/publisher.h"
#include "daemon/io/recorder.h"
#include "daemon/rt/guard_status.h"
#include "estimator/fdi/alarm_book.h"

namespace monitor::detection {

/// Sets the conditions recorder.disk_full, recorder.write_failed, recorder.dropping (messages lost
/// to a full queue since the last call), recorder.log_removed, lcm.send_failed and evidence.failed
/// in `book`, and calls `changed` for each alarm that came or went. Call once a second; the counts
/// refer to the time since the last call.
class SystemAlarms {
 public:
  void report(const io::PublisherStatus& publisher, const io::RecorderStatus& recorder,
              std::int64_t tick, estimator::fdi::AlarmBook& book,
              const std::function<void(const estimator::fdi::Alarm&)>& changed,
              const io::EvidenceStatus& evidence = {});

 private:
  std::int64_t dropped_before_ = 0;
  std::int64_t removed_before_ = 0;
  std::int64_t failures_before_ = 0;
  std::int64_t no_evidence_before_ = 0;
};

/// Alarms for the guards: source "loop", name = the guard's id.
class GuardAlarms {
 public:
  /// Declares one alarm for each guard (control::all_guards) in `book`, which must
  /// outlive this object.
  GuardAlarms(const std::vector<control::GuardConfig>& guards, estimator::fdi::AlarmBook& book);

  /// Declares the alarms in another book, which replaces the first.
  void declare_in(estimator::fdi::AlarmBook& book);
  /// The same guards with other limits, for the next declare_in().
  void set_limits(std::vector<control::GuardConfig> guards) { guards_ = std::move(guards); }

  /// Updates the alarms from `status` and calls `changed` for each alarm that came or went. A guard
  /// that was active for a single tick raises its alarm until the next call.
  void report(rt::GuardStatus& status, std::int64_t tick,
              const std::function<void(const estimator::fdi::Alarm&)>& changed);

 private:
  struct Entry {
    std::size_t number;  ///< index in the book
    estimator::fdi::Severity severity;
    std::string reason;
  };
  std::vector<control::GuardConfig> guards_;
  std::vector<Entry> entries_;
  estimator::fdi::AlarmBook* book_ = nullptr;
  std::uint32_t published_ = 0;
};

/// Alarms for rod sensors that the voter has excluded: source "loop", name rod_ID_out.
class RodAlarms {
 public:
  /// `rods`: sensor ids, the configured one first.
  RodAlarms(std::vector<std::string> rods, double sample_time_s);

  /// True when "SOURCE.NAME" or "NAME" may name one of these alarms.
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
