// What the fault detection could see now: of each source that finds values smallest_NAME, the
// smallest change of NAME that the present motion would show, and, where it tells too little, why.
//
// The detector notes, the main thread reads: a lock for as long as a few numbers are copied.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "estimator/fdi/pipeline.h"

namespace monitor::io {

struct Detectable {
  struct Change {
    std::string name;  ///< with its unit, as "supply_pressure_Pa"
    double smallest;   ///< SI; NaN: not known
  };
  std::string source;
  std::int64_t tick = 0;
  std::string why;  ///< it tells too little, and which motion would; empty: it tells all
  std::vector<Change> changes;
};

class DetectableBoard {
 public:
  /// What it finds; nothing where it has no such value.
  void note(const estimator::fdi::EstimateEvent& event);
  /// Its sources may be gone.
  void clear();
  [[nodiscard]] std::vector<Detectable> read() const;

 private:
  mutable std::mutex mutex_;
  std::vector<Detectable> sources_;  // under mutex_
};

}  // namespace monitor::io
