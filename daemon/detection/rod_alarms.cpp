#include "daemon/detection/rod_alarms.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace monitor::detection {

using config::signals::Sample;
using control::RodFault;
using estimator::fdi::Alarm;
using estimator::fdi::AlarmBook;
using estimator::fdi::Severity;

namespace {

const char* describe(RodFault fault) {
  switch (fault) {
    case RodFault::none:
      break;
    case RodFault::missing:
      return "position missing";
    case RodFault::stale:
      return "position too old";
    case RodFault::frozen:
      return "reading frozen while another sensor sees motion";
    case RodFault::jump:
      return "position jumped";
    case RodFault::outvoted:
      return "reading off the middle of the others";
  }
  return "";
}

}  // namespace

RodAlarms::RodAlarms(std::vector<std::string> rods, double sample_time_s)
    : rods_(std::move(rods)), sample_time_s_(sample_time_s) {
  for (const std::string& rod : rods_) names_.push_back("rod_" + rod + "_out");
}

void RodAlarms::report(const Sample& sample, AlarmBook& book,
                       const std::function<void(const Alarm&)>& changed) {
  if (sample.rod_count == 0) return;
  const std::size_t count = std::min<std::size_t>(sample.rod_count, rods_.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (sample.rod_fault[i] == published_[i]) continue;
    published_[i] = sample.rod_fault[i];
    char reason[200] = "";
    if (published_[i] != 0) {
      const std::string& in_charge =
          rods_[std::min<std::size_t>(sample.rod_in_charge, rods_.size() - 1)];
      std::snprintf(reason, sizeof reason,
                    "excluded since %.3f s after the start: %s; the controller uses %.40s",
                    static_cast<double>(sample.tick) * sample_time_s_,
                    describe(static_cast<RodFault>(published_[i])), in_charge.c_str());
    }
    const Alarm* alarm = book.set_condition("loop", names_[i], Severity::major, published_[i] != 0,
                                            reason, sample.tick);
    if (alarm != nullptr) changed(*alarm);
  }
}

}  // namespace monitor::detection
