// Samples that a request leaves out of fit and score.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace workbench::fit {

struct RecordTimes {
  std::string name;
  const std::vector<double>* t_s = nullptr;
};

/// Calls `take` for each sample within the spans "from:to" or "RECORD@from:to", s. Throws
/// config::schema::UsageError for another form and for a span without samples.
void for_ignored(const std::vector<std::string>& spans, const std::vector<RecordTimes>& records,
                 const std::function<void(std::size_t record, std::size_t sample)>& take);

}  // namespace workbench::fit
