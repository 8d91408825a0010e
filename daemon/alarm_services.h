// The services around a session's alarms: persistence across a restart, audit file, evidence
// folders and the queues that carry operator commands to the detector.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>

#include "daemon/daemon_config.h"
#include "daemon/detection/alarm_command_queue.h"
#include "daemon/detection_config.h"
#include "daemon/io/audit.h"
#include "daemon/io/background_writer.h"
#include "estimator/fdi/pipeline.h"

namespace monitor {

class AlarmServices {
 public:
  /// Facts of the session that the services need.
  struct Session {
    std::string config_hash;
    std::int64_t run_id;
    double sample_time_s;
    bool virtual_time;  ///< no alarm state is read from or kept for another run
  };
  /// Construct before the detector. Throws config::schema::Error when the evidence folder is
  /// unusable.
  AlarmServices(DaemonConfig& config, const DetectionConfig& detection_config,
                const Session& session);
  AlarmServices(const AlarmServices&) = delete;
  AlarmServices& operator=(const AlarmServices&) = delete;

  /// Restores the alarm states saved before the restart. Call once all alarms are declared.
  void restore(estimator::fdi::Pipeline& pipeline, std::int64_t utc_us, std::ostream& log) const;
  /// Writes what is left of the history and reports missing lines. Call after the detector's end.
  void finish(std::ostream& log) const;

  detection::AlarmCommandQueue commands;
  detection::AlarmAnswerQueue answers;

 private:
  std::unique_ptr<io::BackgroundWriter> writer_;  ///< outlives those that post to it

 public:
  /// Null unless configured.
  std::unique_ptr<io::AlarmStore> store;
  std::unique_ptr<io::Audit> audit;
  std::unique_ptr<io::Evidence> evidence;
  std::uint64_t pipeline_hash = 0;
};

}  // namespace monitor
