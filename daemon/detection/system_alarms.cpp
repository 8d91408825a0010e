#include "daemon/detection/system_alarms.h"

#include <cstring>
#include <string>

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
  dropped_before_ = recorder.dropped_records;
  failures_before_ = publisher.send_failures;
}

}  // namespace monitor::detection
