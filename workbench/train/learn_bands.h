// Alarm bands learned from healthy records with a configuration's own estimators. The method:
// estimator/fdi/learn.h.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "config/record/record.h"
#include "estimator/fdi/learned_bands.h"
#include "estimator/fdi/pipeline.h"

namespace workbench::train {

struct LearnOptions {
  std::string config;  ///< the configuration's file, for messages
  double false_alarm_time_s = 86400.0;
  /// Period of the motion, 0 for none; NaN: found in the first record.
  double period_s = std::numeric_limits<double>::quiet_NaN();
};

/// The quantities of bands without limits, or else of all bands. Throws config::schema::ConfigError
/// when there is none.
[[nodiscard]] std::vector<std::string> wanted_quantities(
    const estimator::fdi::PipelineConfig& pipeline, const std::string& file);

/// Each record is run through estimators that begin afresh; all of one sample time. At least one
/// record. Throws config::schema::ConfigError for a quantity that nothing estimates, DataError for
/// records too short or without valid estimates.
[[nodiscard]] estimator::fdi::LearnedBands learn_bands(
    const estimator::fdi::PipelineConfig& pipeline, const std::vector<std::string>& quantities,
    std::span<const config::record::Record> records, const LearnOptions& options);

}  // namespace workbench::train
