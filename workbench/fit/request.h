// Request of `spoolwatch fit`, checked before anything is computed.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "config/record/reading.h"
#include "estimator/greybox/estimation.h"
#include "workbench/fit/parameter_selection.h"

namespace workbench::fit {

struct FitRequest {
  std::string model;
  std::vector<std::string> records;
  std::vector<std::string> holdouts;
  config::record::ReadOptions reading;
  std::string fit = "all";
  ParameterSelection selection;
  std::vector<std::string> ignored;  ///< "from:to" in s, or "RECORD@from:to"
  std::vector<double> weights;       ///< one for each record; empty: all 1
  int starts = 4;
  std::vector<std::string> profiles;  ///< names, "doubtful" or "none"
  double observer_per_s = greybox::kObserver_per_s;
  unsigned threads = 0;  ///< 0: one for each processor
  std::vector<std::string> assignments;
  std::string output;
  std::string json;  ///< "-": standard output
  std::string report;
  bool quiet = false;
  std::string command;  ///< the command line as it was typed, for reports and model files
};

struct PreparedFit {
  greybox::EstimationProblem problem;
  greybox::EstimationOptions options;
  double noise_floor_m = 0.0;  ///< NaN: unknown
  std::vector<std::string> notes;
  std::string command;                            ///< as it was typed
  std::string output;                             ///< the model file that is written, or empty
  std::chrono::steady_clock::time_point begin{};  ///< time at which reading began
};

/// Reads everything. Throws config::schema::UsageError for contradictory options, DataError and
/// ConfigError for files that cannot be used.
[[nodiscard]] PreparedFit prepare(const FitRequest& request);

}  // namespace workbench::fit
