#include "daemon/detection/system_alarms.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>

namespace monitor::detection {

using estimator::fdi::Severity;

void SystemAlarms::report(const io::PublisherStatus& publisher, const io::RecorderStatus& recorder,
                          std::int64_t tick, estimator::fdi::AlarmBook& book,
                          const std::function<void(const estimator::fdi::Alarm&)>& changed,
                          const io::EvidenceStatus& evidence) {
  const auto set = [&](const char* source, const char* name, Severity severity, bool active,
                       const std::string& reason) {
    if (const auto* alarm = book.set_condition(source, name, severity, active, reason, tick)) {
      changed(*alarm);
    }
  };
  const std::string why = recorder.error == 0 ? "" : std::strerror(recorder.error);
  set("recorder", "disk_full", Severity::minor, recorder.disk_full,
      recorder.disk_full ? why + "; the newest data is kept in memory" : "");
  set("recorder", "write_failed", Severity::minor, recorder.write_failed,
      recorder.write_failed ? why + "; the newest data is kept in memory" : "");
  const std::int64_t dropped = recorder.dropped_records - dropped_before_;
  set("recorder", "dropping", Severity::minor, dropped > 0,
      dropped > 0 ? "the queue to the recorder was full; messages are missing in the log" : "");
  const std::int64_t removed = recorder.removed_records - removed_before_;
  set("recorder", "log_removed", Severity::minor, removed > 0,
      removed > 0 ? "a log was removed while it was written; " + std::to_string(removed) +
                        " messages are on no disk"
                  : "");
  const std::int64_t failures = publisher.send_failures - failures_before_;
  set("lcm", "send_failed", Severity::minor, failures > 0,
      failures > 0 ? "LCM could not send messages; is the network up?" : "");
  const std::int64_t no_evidence = evidence.failed + evidence.skipped - no_evidence_before_;
  set("evidence", "failed", Severity::minor, no_evidence > 0,
      no_evidence <= 0      ? ""
      : evidence.error != 0 ? std::string("evidence of an alarm could not be written: ") +
                                  std::strerror(evidence.error)
                            : "too many alarms at once: some have no evidence");
  no_evidence_before_ += no_evidence;
  removed_before_ = recorder.removed_records;
  dropped_before_ = recorder.dropped_records;
  failures_before_ = publisher.send_failures;
}

using control::Action;
using estimator::fdi::Alarm;

namespace {

const char* consequence(Action action) {
  constexpr const char* kTexts[] = {"",
                                    "",
                                    ": in RUN the reference is held until start",
                                    ": in RUN the command ramps to null, then DISARMED",
                                    ": DISARMED",
                                    ": in RUN LATCHED until reset"};
  return kTexts[static_cast<std::size_t>(action)];
}

}  // namespace

GuardAlarms::GuardAlarms(const std::vector<control::GuardConfig>& guards,
                         estimator::fdi::AlarmBook& book)
    : guards_(guards) {
  declare_in(book);
}

void GuardAlarms::declare_in(estimator::fdi::AlarmBook& book) {
  book_ = &book;
  entries_.clear();
  for (const control::GuardConfig& guard : guards_) {
    const control::GuardKind kind = guard.which();
    const control::Guard limits(guard);
    Alarm alarm;
    alarm.source = "loop";
    alarm.name = guard.id;
    alarm.quantity = control::to_string(kind);
    alarm.guidance = guard.guidance.empty() ? control::guidance_of(kind) : guard.guidance;
    alarm.rules = book_->condition_rules();
    alarm.low = limits.low();
    alarm.high = limits.high();
    const Action action = control::action_of(guard.action);
    const Severity severity = action == Action::indicate ? Severity::minor : Severity::major;
    entries_.push_back({book_->declare(std::move(alarm)), severity,
                        std::string(control::reason_of(kind)) + consequence(action)});
  }
}

void GuardAlarms::report(rt::GuardStatus& status, std::int64_t tick,
                         const std::function<void(const Alarm&)>& changed) {
  const std::uint32_t now = status.take_raised() | status.active();
  if (now == published_) return;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const std::uint32_t bit = 1U << i;
    if (((now ^ published_) & bit) == 0) continue;
    const bool active = (now & bit) != 0;
    estimator::fdi::AlarmInput state;
    state.severity = active ? entries_[i].severity : Severity::ok;
    state.tick = tick;
    state.value = status.value(i);
    if (active) {
      const Alarm& limits = book_->alarm(entries_[i].number);
      state.reason = entries_[i].reason;
      state.direction = state.value > limits.high ? 1 : state.value < limits.low ? -1 : 0;
    }
    if (const Alarm* alarm = book_->set(entries_[i].number, state)) changed(*alarm);
  }
  published_ = now;
}

using config::signals::Sample;
using control::RodFault;
using estimator::fdi::AlarmBook;

namespace {

const char* describe(RodFault fault) {
  constexpr const char* kTexts[] = {"",
                                    "position missing",
                                    "position too old",
                                    "reading frozen while another sensor sees motion",
                                    "position jumped",
                                    "reading off the middle of the others"};
  return kTexts[static_cast<std::size_t>(fault)];
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
