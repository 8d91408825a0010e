// What the fault detection could see now: of each source that finds values smallest_NAME, the
// smallest change of NAME that the present motion would show, and, where it tells too little, why.
//
// The detector notes, the main thread reads: a lock for as long as a few numbers are copied.
#pragma once

#include <mutex>
#include <vector>

#include "daemon/io/control_messages.h"
#include "estimator/fdi/pipeline.h"

namespace monitor::detection {

class DetectabilityMonitor {
 public:
  /// What it finds; nothing where it has no such value.
  void update(const estimator::fdi::EstimateEvent& event);
  /// Its sources may be gone.
  void clear();
  [[nodiscard]] std::vector<io::Detectable> read() const;

 private:
  mutable std::mutex mutex_;
  std::vector<io::Detectable> sources_;  // under mutex_
};

}  // namespace monitor::detection
