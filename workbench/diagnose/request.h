// What `spoolwatch diagnose` is asked for, checked before anything is computed.
#pragma once

#include <string>
#include <vector>

#include "workbench/diagnose/outcome.h"

namespace workbench::diagnose {

struct Request {
  std::string model;
  std::vector<std::string> records;
  std::vector<std::string> holdouts;
  std::string fit = "blocks";
  std::string json;  ///< "-": standard output
  std::string report;
  std::string output;
  unsigned threads = 0;  ///< 0: one for each processor
  std::vector<std::string> assignments;
  bool quiet = false;
  std::string command;  ///< the command line as it was typed, for reports and model files
};

/// Reads everything. Throws config::schema::UsageError for a hold-out that is fitted too or for
/// outputs over inputs, DataError and ConfigError for files that cannot be used, 1 for outputs that
/// could not be written in the end.
[[nodiscard]] Outcome prepare(const Request& request);

}  // namespace workbench::diagnose
