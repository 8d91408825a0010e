#include "daemon/alarm_keeping.h"

#include <ostream>

#include "config/schema/hash.h"
#include "daemon/rules.h"

namespace monitor {
AlarmKeeping::AlarmKeeping(DaemonConfig& config, const Rules& rules, const Session& session) {
  pipeline_hash = config::schema::hash_of(rules.text);
  if (!config.evidence.folder.empty()) {
    evidence = std::make_unique<io::Evidence>(
        config.evidence,
        io::EvidenceFacts{config.rig_id, session.config_hash, config.lcm.prefix, session.run_id,
                          session.sample_time_s, evidence_files(config, rules.text)},
        !session.virtual_time);
  }
  if (config.alarms.folder.empty() || session.virtual_time) return;
  clerk_ = std::make_unique<io::Clerk>();
  store = std::make_unique<io::AlarmStore>(config.alarms.folder, config.rig_id, *clerk_);
  audit = std::make_unique<io::Audit>(config.alarms.folder, config.alarms.audit_bytes, *clerk_);
}

void AlarmKeeping::bring_back(estimator::fdi::Pipeline& pipeline, std::int64_t utc_us,
                              std::ostream& log) const {
  if (store == nullptr) return;
  const io::LoadedLives loaded = store->load(utc_us);
  if (!loaded.wrong.empty()) {
    log << "spoolwatchd: " << store->file().string() << ": " << loaded.wrong
        << "; all alarms begin anew" << std::endl;
  }
  pipeline.alarms().restore(loaded.lives);
}

}  // namespace monitor
