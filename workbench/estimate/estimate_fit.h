// ARX structures fitted to a record and judged on it: what `spoolwatch estimate` computes.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "config/record/record.h"
#include "estimator/estimate.h"

namespace workbench::estimate {

struct EstimateOptions {
  estimator::Structure structure;
  std::string method = "batch";                                ///< batch, sliding, recursive
  double window_s = std::numeric_limits<double>::quiet_NaN();  ///< NaN: the whole record
  double stride_s = std::numeric_limits<double>::quiet_NaN();  ///< NaN: the window
  double forgetting = 1.0;
  double prior_variance = 1e8;
  std::string detrend = "none";  ///< none, mean, linear: of u and y of the whole record
  double offset_m = 0.0;         ///< subtracted from y
  std::string filter = "none";   ///< none, low, high, band: of u and y, settled again at each gap
  double filter_low_Hz = std::numeric_limits<double>::quiet_NaN();   ///< for high and band
  double filter_high_Hz = std::numeric_limits<double>::quiet_NaN();  ///< for low and band
  int decimation = 1;
  double fit_from = 0.0;  ///< shares of the record that is fitted
  double fit_to = 1.0;
};

/// Coefficients and how well they predict.
struct JudgedEstimate {
  estimator::Estimate estimate;
  double from_s = 0.0;   ///< first sample fitted
  double to_s = 0.0;     ///< last sample fitted
  double cost_m2 = 0.0;  ///< free run, first n samples measured; NaN when none is left to judge
  double free_run_rms_m = 0.0;
  double one_step_rms_m = 0.0;
};

struct EstimateResult {
  JudgedEstimate whole;
  double scored_from_s = 0.0;  ///< cost and RMS of `whole` count from here
  double scored_to_s = 0.0;
  std::vector<JudgedEstimate> windows;
};

/// The errors are taken over the samples that were not fitted (those after fit_to, or else those
/// before fit_from), or over all when all were fitted; a window's over the window. Each stretch
/// between gaps starts a free run of its own. Throws schema::DataError when the record is
/// too short for the structure.
[[nodiscard]] EstimateResult estimate_record(const config::record::Record& record,
                                             const EstimateOptions& options);

}  // namespace workbench::estimate
