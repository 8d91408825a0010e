#include "daemon/alarm_services.h"

#include <ostream>

#include "config/schema/hash.h"
#include "daemon/detection_config.h"

namespace monitor {
AlarmServices::AlarmServices(DaemonConfig& config, const DetectionConfig& detection_config,
                             const Session& session) {
  pipeline_hash = config::schema::hash_of(detection_config.text);
  if (!config.evidence.folder.empty()) {
    evidence = std::make_unique<io::Evidence>(
        config.evidence,
        io::EvidenceFacts{config.rig_id, session.config_hash, config.lcm.prefix, session.run_id,
                          session.sample_time_s, evidence_files(config, detection_config.text)},
        !session.virtual_time);
  }
  if (config.alarms.folder.empty() || session.virtual_time) return;
  writer_ = std::make_unique<io::BackgroundWriter>();
  store = std::make_unique<io::AlarmStore>(config.alarms.folder, config.rig_id, *writer_,
                                           config.alarms.audit_bytes);
  audit = std::make_unique<io::Audit>(config.alarms.folder, config.alarms.audit_bytes, *writer_);
}

void AlarmServices::restore(estimator::fdi::Pipeline& pipeline, std::int64_t utc_us,
                            std::ostream& log) const {
  if (store == nullptr) return;
  const io::LoadedLives loaded = store->load(utc_us);
  if (!loaded.wrong.empty()) {
    log << "spoolwatchd: " << store->file().string() << ": " << loaded.wrong
        << "; all alarms start from their initial state" << std::endl;
  }
  pipeline.alarms().restore(loaded.lives);
}

void AlarmServices::finish(std::ostream& log) const {
  const std::int64_t missing = store != nullptr ? store->finish() : 0;
  if (missing == 0) return;
  log << "spoolwatchd: " << store->history_file().string() << ": " << missing
      << " lines could not be written: the statistics lack them" << std::endl;
}

}  // namespace monitor
