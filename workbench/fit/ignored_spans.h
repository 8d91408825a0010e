// Samples that a request leaves out of fit and score.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace config::record {
struct Record;
}

namespace workbench::fit {

struct RecordTimes {
  std::string name;
  const std::vector<double>* t_s = nullptr;
};

/// Calls `take` for each sample within the spans "from:to" or "RECORD@from:to", s. Throws
/// config::schema::UsageError for another form and for a span without samples.
void for_ignored(const std::vector<std::string>& spans, const std::vector<RecordTimes>& records,
                 const std::function<void(std::size_t record, std::size_t sample)>& take);

/// Takes these samples out of the records, which then have gaps there: they correct no simulation.
/// `names` as the user gave them. Throws like for_ignored().
void cut_ignored(const std::vector<std::string>& spans, const std::vector<std::string>& names,
                 std::vector<config::record::Record>& records);

/// Takes the samples where `ignored` is not 0 out of a record, which then has gaps there.
void cut_samples(const std::vector<char>& ignored, config::record::Record& record);

}  // namespace workbench::fit
