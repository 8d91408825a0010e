// What a session keeps of its alarms: their lives across a restart, who did what, evidence, and the
// way of people's acts to the detector.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>

#include "daemon/daemon_config.h"
#include "daemon/detection/alarm_command_queue.h"
#include "daemon/io/audit.h"
#include "daemon/io/clerk.h"
#include "daemon/rules.h"
#include "estimator/fdi/pipeline.h"

namespace monitor {

class AlarmKeeping {
 public:
  /// What of the session it needs to know.
  struct Session {
    std::string config_hash;
    std::int64_t run_id;
    double sample_time_s;
    bool virtual_time;  ///< nothing of another run is read, nothing is left to the next
  };
  /// Before the detector. Throws config::schema::Error when evidence cannot be kept.
  AlarmKeeping(DaemonConfig& config, const Rules& rules, const Session& session);
  AlarmKeeping(const AlarmKeeping&) = delete;
  AlarmKeeping& operator=(const AlarmKeeping&) = delete;

  /// Once all alarms are declared: their lives from before the restart.
  void bring_back(estimator::fdi::Pipeline& pipeline, std::int64_t utc_us, std::ostream& log) const;

  detection::AlarmOrderQueue orders;
  detection::AlarmAnswerQueue answers;
  /// Null where the configuration asks for none.
  std::unique_ptr<io::AlarmStore> store;
  std::unique_ptr<io::Audit> audit;
  std::unique_ptr<io::Evidence> evidence;
  std::uint64_t pipeline_hash = 0;

 private:
  std::unique_ptr<io::Clerk> clerk_;
};

}  // namespace monitor
