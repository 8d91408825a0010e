// Detectability: for each source with outputs smallest_NAME, the smallest change of NAME that the
// present motion would reveal, why the motion is insufficient where it is, and what disturbs the
// rig (outputs disturbance_NAME).
//
// Written by the detector, read by the main thread; a mutex is held while a few numbers are copied.
#pragma once

#include <mutex>
#include <vector>

#include "daemon/io/control_messages.h"
#include "estimator/fdi/pipeline.h"

namespace monitor::detection {

class DetectabilityMonitor {
 public:
  /// Stores the event's smallest_NAME and disturbance_NAME values; ignores events without any of
  /// the former.
  void update(const estimator::fdi::EstimateEvent& event);
  /// Forgets all sources, after a change of the configuration.
  void clear();
  [[nodiscard]] std::vector<io::Detectable> read() const;

 private:
  mutable std::mutex mutex_;
  std::vector<io::Detectable> sources_;  // under mutex_
};

}  // namespace monitor::detection
