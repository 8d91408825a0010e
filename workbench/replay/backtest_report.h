// A backtest as lines for people and as JSON.
#pragma once

#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "workbench/replay/backtest_runs.h"
#include "workbench/replay/occurrences.h"

namespace workbench::replay {

struct BacktestReport {
  std::string new_rules;
  std::string old_rules;  ///< file, empty: what was recorded
  std::vector<BacktestRun> runs;
  std::vector<OccurrenceDifference> differences;  ///< one for each run
};

void print_backtest(const BacktestReport& report, std::ostream& out);
[[nodiscard]] nlohmann::ordered_json backtest_json(const BacktestReport& report);

}  // namespace workbench::replay
