// Alarms for failures of publishing, recording and evidence.
#pragma once

#include <cstdint>
#include <functional>

#include "daemon/io/evidence.h"
#include "daemon/io/publisher.h"
#include "daemon/io/recorder.h"
#include "estimator/fdi/alarm_book.h"

namespace monitor::detection {

/// Sets the conditions recorder.disk_full, recorder.write_failed, recorder.dropping (messages lost
/// to a full queue since the last call), lcm.send_failed and evidence.failed in `book`, and calls
/// `changed` for each alarm that came or went. Call once a second; the counts refer to the time
/// since the last call.
class SystemAlarms {
 public:
  void report(const io::PublisherStatus& publisher, const io::RecorderStatus& recorder,
              std::int64_t tick, estimator::fdi::AlarmBook& book,
              const std::function<void(const estimator::fdi::Alarm&)>& changed,
              const io::EvidenceStatus& evidence = {});

 private:
  std::int64_t dropped_before_ = 0;
  std::int64_t failures_before_ = 0;
  std::int64_t no_evidence_before_ = 0;
};

}  // namespace monitor::detection
