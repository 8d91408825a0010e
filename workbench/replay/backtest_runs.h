// Old logs through a new configuration: the alarms of each run of the daemon as it would tell them
// and as it told them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "estimator/fdi/pipeline.h"
#include "estimator/fdi/tracker/detection_method_kinds.h"

namespace workbench::replay {

/// Each time that an alarm stood, and how two lists of them compare.
/// An alarm from its coming to its going.
struct Occurrence {
  std::string alarm;  ///< SOURCE.NAME
  double from_s = 0.0;
  double to_s = std::numeric_limits<double>::quiet_NaN();  ///< NaN: it stood at the log's end
  int severity = 0;                                        ///< when it came, as in alarm_t
  int direction = 0;
};

/// Alarms that come and go, as occurrences in the order of their coming.
class OccurrenceList {
 public:
  /// A state of an alarm at a time, whether it is another or not.
  void tell(const std::string& alarm, double t_s, bool active, int severity, int direction);
  [[nodiscard]] const std::vector<Occurrence>& all() const noexcept { return all_; }

 private:
  std::vector<Occurrence> all_;
};

struct Shift {
  Occurrence before, after;
};

struct OccurrenceDifference {
  std::vector<Occurrence> appears, disappears;
  std::vector<Shift> shifts;  ///< comes or goes at another time, or in another direction
  std::int64_t same = 0;
};

/// Two of one alarm are the same one when they overlap, or come within `tolerance_s`; each is
/// matched once, in the order of time. Times that differ by less than `sample_s` are equal.
[[nodiscard]] OccurrenceDifference compare(const std::vector<Occurrence>& before,
                                           const std::vector<Occurrence>& after, double tolerance_s,
                                           double sample_s);

namespace tracker = estimator::fdi::tracker;

/// The alarms' part of a configuration file.
struct BacktestRules {
  std::string file;
  std::filesystem::path folder;  ///< bands_file starts here
  std::string rig_id;            ///< "" where the file does not say
  estimator::fdi::PipelineConfig pipeline{tracker::detection_method_kinds()};
};

/// Throws config::schema::ConfigError.
[[nodiscard]] BacktestRules read_rules(const std::string& file);

/// One run of the daemon, or one CSV record.
struct BacktestRun {
  std::vector<std::string> files;  ///< in the order of time
  double sample_time_s = 0.0;
  double from_s = 0.0, to_s = 0.0;  ///< of its samples
  std::int64_t samples = 0;
  bool has_recorded_alarms = false;  ///< a CSV record has none
  std::vector<Occurrence> after;     ///< by the new rules
  std::vector<Occurrence> before;    ///< by the old ones, or as recorded
};

/// `logs`: LCM event logs, folders of them, records. Logs of one run are put together. `old_rules`
/// empty: what was recorded. Throws config::schema::DataError ( 78).
[[nodiscard]] std::vector<BacktestRun> run_backtest(const BacktestRules& new_rules,
                                                    const std::optional<BacktestRules>& old_rules,
                                                    const std::vector<std::string>& logs);

/// Report on a new configuration, as lines for people and as JSON.
struct BacktestReport {
  std::string new_rules;
  std::string old_rules;  ///< file, empty: what was recorded
  std::vector<BacktestRun> runs;
  std::vector<OccurrenceDifference> differences;  ///< one for each run
};

void print_backtest(const BacktestReport& report, std::ostream& out);
[[nodiscard]] nlohmann::ordered_json backtest_json(const BacktestReport& report);

}  // namespace workbench::replay
