#include "daemon/rt/detector.h"

namespace monitor::rt {

using estimator::fdi::Alarm;
using estimator::fdi::AlarmBook;
using estimator::fdi::Severity;

void Detector::take_rules() {
  std::shared_ptr<RuleChange> change;
  while (parts_.new_rules != nullptr && parts_.new_rules->pop(change)) {
    change_rules(*change);
    parts_.taken_rules->push(change);
  }
}

void Detector::change_rules(RuleChange& change) {
  estimator::fdi::Pipeline& next = *change.pipeline;
  AlarmBook& before = parts_.pipeline.alarms();
  guard_alarms_.declare_in(next.alarms());
  next.alarms().adopt_conditions(before);
  const std::vector<bool> goes_on = next.inherit(parts_.pipeline);
  for (std::size_t i = 0; i < goes_on.size(); ++i) {
    (goes_on[i] ? change.warm : change.cold).push_back(change.estimators[i]);
  }
  for (const Alarm& alarm : before.alarms()) {
    const std::string id = alarm.source + "." + alarm.name;
    if (!alarm.stands() || next.alarms().find(id) != AlarmBook::kNone) continue;
    Alarm ended = alarm;
    ended.severity = Severity::ok;
    ended.active = ended.latched = ended.first_up = ended.shelved = ended.chattering = false;
    ended.acknowledged = true;
    ended.direction = 0;
    ended.tick = tick_;
    ended.reason = "it is no longer in the configuration";
    parts_.publisher.alarm(ended, false, stamp());
    change.ended.push_back(id);
  }
  std::swap(parts_.pipeline, next);
  if (parts_.detectable != nullptr) parts_.detectable->clear();
  parts_.pipeline_hash = change.pipeline_hash;
  health_.config_hash = change.config_hash;
  // An alarm that stood before has its evidence.
  times_.clear();
  for (const Alarm& alarm : parts_.pipeline.alarms().alarms()) times_.push_back(alarm.times);
  if (parts_.evidence != nullptr) parts_.evidence->reconfigure(std::move(change.evidence_files));
  change.tick = tick_;
}

}  // namespace monitor::rt
