// Bands learned from a healthy record: the file that `spoolwatch calibrate` writes and a
// configuration names as bands_file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/schema/visitor.h"

namespace estimator::fdi {

/// TOML [[learned]]: limits of one quantity, in its own unit.
struct LearnedBand {
  std::string quantity;
  std::string structure;  ///< structure of the estimator, "arx111"
  std::string estimator;  ///< EstimatorConfig::fingerprint() of its estimator
  double low = 0.0;
  double high = 0.0;
  double hysteresis = 0.0;
  double centre = 0.0;         ///< mean of the healthy estimates
  std::int64_t estimates = 0;  ///< number of them
  double block_s = 0.0;        ///< length of the blocks whose extremes were fitted
  // Not in the file:
  double widening_ratio = 1.0;  ///< margin over that of a record without end
  double enough_s = 0.0;        ///< length of healthy motion that brings widening_ratio below 1.1

  void visit(config::schema::Visitor& v);
};

struct LearnedBands {
  double sample_time_s = 0.0;
  std::string source;  ///< the healthy record
  double false_alarm_time_s = 0.0;
  std::vector<LearnedBand> bands;

  void visit(config::schema::Visitor& v);
};

}  // namespace estimator::fdi
