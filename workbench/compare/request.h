// The request of `spoolwatch compare`, checked before anything is computed.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "config/record/reading.h"
#include "config/record/record.h"
#include "estimator/greybox/dataset.h"
#include "estimator/greybox/observer_simulation.h"
#include "plant_sim/model_file.h"

namespace workbench::compare {

namespace greybox = estimator::greybox;

struct CompareRequest {
  std::string model;
  std::string record;
  config::record::ReadOptions reading;
  std::vector<std::string> ignored;  ///< "from:to" in s, or "RECORD@from:to"
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
  double observer_per_s = greybox::kObserver_per_s;
  std::vector<std::string> assignments;
};

struct PreparedComparison {
  plant_sim::ModelFile model;
  greybox::Dataset record;
  config::record::RecordUnits units;
};

/// Reads model and record. Throws config::schema::UsageError for options that leave too little of
/// the record, DataError and ConfigError for files that cannot be used.
[[nodiscard]] PreparedComparison prepare(const CompareRequest& request);

}  // namespace workbench::compare
