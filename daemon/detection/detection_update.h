// New rules for the fault detection on their way to the detector and back: made and checked on the
// main thread, handed over through a bounded queue, taken between two samples, and handed back with
// what became of them and with the old rules, which the main thread then lets go.
#pragma once

#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "daemon/io/evidence.h"
#include "estimator/fdi/pipeline.h"

namespace monitor::detection {

struct DetectionUpdate {
  std::unique_ptr<estimator::fdi::Pipeline> pipeline;  ///< the new one; handed back: the old one
  std::uint64_t pipeline_hash = 0;                     ///< schema::hash_of(whole_text)
  std::string config_hash;                             ///< of the whole configuration
  std::vector<std::string> estimators;                 ///< ids of all sources, in their order
  std::vector<io::EvidenceFile> evidence_files;

  // What became of it.
  std::int64_t tick = 0;           ///< of the last sample under the old rules
  std::vector<std::string> warm;   ///< estimators that go on with their windows
  std::vector<std::string> cold;   ///< estimators that warm up
  std::vector<std::string> ended;  ///< alarms that stood and are no more
};

using DetectionUpdateQueue =
    boost::lockfree::spsc_queue<std::shared_ptr<DetectionUpdate>, boost::lockfree::capacity<2>>;

}  // namespace monitor::detection
