// The request of `spoolwatch diagnose`, checked before anything is computed.
#pragma once

#include <string>
#include <vector>

#include "config/record/reading.h"
#include "estimator/greybox/fit_dataset.h"
#include "estimator/greybox/selection/problem.h"
#include "workbench/fit/parameter_selection.h"

namespace workbench::diagnose {

namespace greybox = estimator::greybox;
namespace selection = estimator::greybox::selection;

struct DiagnosisRequest {
  std::string model;
  std::vector<std::string> records;
  std::vector<std::string> holdouts;
  config::record::ReadOptions reading;
  std::string fit = "blocks";
  std::vector<std::string> only;      ///< the only effects to be tried; empty: all
  std::vector<std::string> without;   ///< effects that are not tried
  fit::ParameterSelection selection;  ///< choice among the model's own parameters
  std::vector<std::string> ignored;   ///< "from:to" in s, or "RECORD@from:to"
  double within_s = 0.0;              ///< the best answer after that time; 0: no limit
  std::string json;                   ///< "-": standard output
  std::string report;
  std::string output;
  unsigned threads = 0;  ///< 0: one for each processor
  std::vector<std::string> assignments;
  bool quiet = false;
  std::string command;  ///< the command line as it was typed, for reports and model files
};

/// The input of a diagnosis: problem and options, and the names that its results are printed under.
struct PreparedDiagnosis {
  selection::DiagnosisProblem problem;
  selection::DiagnosisOptions options;
  std::string model_file;
  std::vector<std::string> records;   ///< as given: fitted, and scored by the split
  std::vector<std::string> holdouts;  ///< as given: scored only
  std::string output;                 ///< file of the better model; empty: none is written
  std::string command;                ///< shell command that repeats this diagnosis
  config::record::ReadOptions reading;
  std::vector<std::string> ignored;  ///< as given
  double within_s = 0.0;             ///< time limit; 0: none
  greybox::Split split = greybox::Split::blocks;
};

/// Reads all files. Throws config::schema::UsageError for a hold-out that is fitted too or for
/// outputs over inputs, DataError and ConfigError for unusable files.
[[nodiscard]] PreparedDiagnosis prepare(const DiagnosisRequest& request);

}  // namespace workbench::diagnose
