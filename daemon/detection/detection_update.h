// An update of the fault detection's configuration: built and checked on the main thread, passed to
// the detector through a bounded queue, applied between two samples, and returned with its effect
// and the old pipeline, which the main thread then destroys.
#pragma once

#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "daemon/control/guard_config.h"
#include "daemon/io/evidence.h"
#include "estimator/fdi/pipeline.h"

namespace monitor::detection {

struct DetectionUpdate {
  std::unique_ptr<estimator::fdi::Pipeline> pipeline;  ///< new pipeline; on return the old one
  std::uint64_t pipeline_hash = 0;                     ///< schema::hash_of(whole_text)
  std::string config_hash;                             ///< hash of the whole configuration
  std::vector<std::string> estimators;                 ///< ids of all sources in order
  std::vector<io::EvidenceFile> evidence_files;
  /// control::all_guards with new limits; empty: they stay.
  std::vector<control::GuardConfig> guards;

  // Filled in by the detector.
  std::int64_t tick = 0;           ///< last sample processed by the old pipeline
  std::vector<std::string> warm;   ///< estimators that continue with their windows
  std::vector<std::string> cold;   ///< estimators that restart
  std::vector<std::string> ended;  ///< standing alarms that no longer exist
};

using DetectionUpdateQueue =
    boost::lockfree::spsc_queue<std::shared_ptr<DetectionUpdate>, boost::lockfree::capacity<2>>;

}  // namespace monitor::detection
