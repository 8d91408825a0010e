// Leads the fault detection through a folder of evidence again and compares what it tells with what
// was told, bit for bit.
//
// The log is the whole input. Samples go through the pipeline, restored from the folder's state.
// Alarms that do not come from the pipeline (guards, the daemon's own) and the acts of people are
// taken from the log at their place, since they may decide which alarm is the first of a burst, or
// what is still latched.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "workbench/replay/pack.h"

namespace workbench::replay {

struct ReplayOutcome {
  std::int64_t samples = 0;
  std::int64_t estimates = 0, estimates_same = 0;
  std::int64_t alarms = 0, alarms_same = 0;  ///< changes told by the pipeline
  bool derived = false;                      ///< the folder's alarm comes from the pipeline
  bool found = false;                        ///< it was told again
  bool alarm_same = false;                   ///< with the same bits
  estimator::fdi::Alarm alarm{};             ///< as told again
  std::vector<std::string> differences{};    ///< the first few, in words

  [[nodiscard]] bool same() const noexcept {
    return estimates == estimates_same && alarms == alarms_same && found && alarm_same;
  }
};

/// Throws config::schema::DataError ( 78) for a folder that is damaged.
[[nodiscard]] ReplayOutcome replay(const Pack& pack);

}  // namespace workbench::replay
