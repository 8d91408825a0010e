// What a session keeps of its alarms: their lives across a restart, who did what, evidence, and the
// way of people's acts to the detector.
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
  /// What of the session it needs to know.
  struct Session {
    std::string config_hash;
    std::int64_t run_id;
    double sample_time_s;
    bool virtual_time;  ///< nothing of another run is read, nothing is left to the next
  };
  /// Before the detector. Throws config::schema::Error when evidence cannot be kept.
  AlarmServices(DaemonConfig& config, const DetectionConfig& detection_config,
                const Session& session);
  AlarmServices(const AlarmServices&) = delete;
  AlarmServices& operator=(const AlarmServices&) = delete;

  /// Once all alarms are declared: their lives from before the restart.
  void restore(estimator::fdi::Pipeline& pipeline, std::int64_t utc_us, std::ostream& log) const;

  detection::AlarmCommandQueue commands;
  detection::AlarmAnswerQueue answers;
  /// Null where the configuration asks for none.
  std::unique_ptr<io::AlarmStore> store;
  std::unique_ptr<io::Audit> audit;
  std::unique_ptr<io::Evidence> evidence;
  std::uint64_t pipeline_hash = 0;

 private:
  std::unique_ptr<io::BackgroundWriter> writer_;
};

}  // namespace monitor
