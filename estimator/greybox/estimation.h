// A model's parameters estimated from records: several starts, the best one polished, how well each
// parameter is known, and what the records cannot see.
//
// cost as in greybox/fit.h; the intervals are x +- 1.96 standard errors of the search value
// (honest for residuals of any colour, estimator/nonlinear/covariance.h), or where the profile of
// the likelihood was walked, the profile's.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "estimator/greybox/fit.h"
#include "estimator/greybox/fit_dataset.h"
#include "estimator/greybox/identifiability_report.h"
#include "estimator/nonlinear/covariance.h"
#include "estimator/nonlinear/profile.h"

namespace estimator::greybox {

enum class Profiling { none, doubtful, named };

struct EstimationProblem {
  plant_sim::ModelFile model;
  FitDataset data;          ///< `validation_mask` may be all 0: nothing is held out
  Eigen::VectorXd weights;  ///< of squared residuals in the fit
  std::vector<FreeParameter> parameters;
  Eigen::VectorXd start;  ///< theta
};

struct EstimationOptions {
  int starts = 4;
  Profiling profiling = Profiling::doubtful;
  std::vector<std::string> profiled;  ///< parameter names, for Profiling::named
  double observer_per_s = kObserver_per_s;
  unsigned threads = 2;
  std::function<bool()> cancel;  ///< may be empty
  std::function<void(const std::string&)>
      progress;  ///< called by the caller's thread; may be empty
};

struct EstimatedParameter {
  FreeParameter free;
  double start = 0.0;  ///< SI, like what follows; the unit is in the name
  double value = 0.0;
  double std_error = 0.0;  ///< NaN at a bound, infinite where nothing sees it
  double low = 0.0;        ///< 95 % interval
  double high = 0.0;
  int at_bound = 0;           ///< -1, 0, +1: of the values
  double record_share = 1.0;  ///< Sight::share after the fit
  std::string doubt;          ///< why a profile is called for; empty: none
  bool from_profile = false;  ///< the interval
  bool low_found = true;      ///< false: no end within the bounds
  bool high_found = true;
  std::vector<estimator::nonlinear::ProfilePoint> profile;  ///< SI, ascending; may be empty
};

struct MultistartCounts {
  int tried = 0;
  int same = 0;       ///< ended in the best minimum
  int elsewhere = 0;  ///< as good within chance, at other values
  int worse = 0;
};

/// Errors of one model, measured less modelled.
struct SimulationErrors {
  double rms_m = 0.0;  ///< drift-corrected, the samples that are fitted
  double heldout_rms_m = std::numeric_limits<double>::quiet_NaN();  ///< NaN: none held out
  double free_run_rms_m = 0.0;                                      ///< nothing corrected
  double fit_percent = 0.0;                                         ///< of the free run
  Eigen::VectorXd residual_m;                                       ///< all samples
  Eigen::VectorXd free_run_m;
};

struct EstimationSummary {
  std::vector<EstimatedParameter> parameters;
  FitSummary fitted;
  plant_sim::ModelFile better;
  double noise_floor_m = 0.0;
  SimulationErrors before;
  SimulationErrors after;
  IdentifiabilityReport identifiability_before;
  IdentifiabilityReport identifiability_after;
  Eigen::MatrixXd correlation;  ///< of the estimates; NaN where there is none
  double effective_samples = 0.0;
  MultistartCounts starts;
  bool interrupted = false;
  double fit_s = 0.0;   ///< time taken up to the standard errors, profiles left out
  int evaluations = 0;  ///< groups of eight simulations, without the profiles'
};

[[nodiscard]] EstimationSummary estimate(const EstimationProblem& problem,
                                         const EstimationOptions& options);

}  // namespace estimator::greybox
