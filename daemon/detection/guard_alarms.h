// Guards as alarms: source "loop", name = the guard's id.
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
  /// Declares one alarm for each guard (control::all_guards) in `book`, which outlives this.
  GuardAlarms(const std::vector<control::GuardConfig>& guards, estimator::fdi::AlarmBook& book);

  /// Declares them in another book, which takes the place of the first.
  void declare_in(estimator::fdi::AlarmBook& book);

  /// Sets the alarms as the status shows them; `changed` is called for each that came or went. A
  /// guard that was active for one tick alone gives an alarm all the same, until the next call.
  void report(rt::GuardStatus& status, std::int64_t tick,
              const std::function<void(const estimator::fdi::Alarm&)>& changed);

 private:
  struct Entry {
    std::size_t number;  ///< in the book
    estimator::fdi::Severity severity;
    std::string reason;
  };
  std::vector<control::GuardConfig> guards_;
  std::vector<Entry> entries_;
  estimator::fdi::AlarmBook* book_ = nullptr;
  std::uint32_t published_ = 0;
};

}  // namespace monitor::detection
