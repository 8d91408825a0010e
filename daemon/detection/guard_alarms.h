// Alarms for the guards: source "loop", name = the guard's id.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/control/guard_config.h"
#include "daemon/rt/guard_status.h"
#include "estimator/fdi/alarm_book.h"

namespace monitor::detection {

class GuardAlarms {
 public:
  /// Declares one alarm for each guard (control::all_guards) in `book`, which must
  /// outlive this object.
  GuardAlarms(const std::vector<control::GuardConfig>& guards, estimator::fdi::AlarmBook& book);

  /// Declares the alarms in another book, which replaces the first.
  void declare_in(estimator::fdi::AlarmBook& book);

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

}  // namespace monitor::detection
