// Estimation of a model's parameters from records: several starts, a final fit from the best one,
// uncertainty and identifiability of each parameter.
//
// The cost is that of greybox/fit.h. Intervals are theta +- 1.96 standard errors, valid for
// coloured residuals (estimator/nonlinear/covariance.h), or those of the likelihood profile where
// one was computed.
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

/// Reason why the standard error describes a parameter's uncertainty badly.
enum class IntervalDoubt {
  none,
  at_bound,
  not_visible,
  large_std_error,  ///< no prior explains it
  not_quadratic     ///< the cost at the ends of the interval is not that of the linear model
};

/// Step of a running estimation.
struct EstimationProgress {
  enum class Step { identifiability, multistart, descent, restart, profile };

  Step step = Step::identifiability;
  std::size_t starts = 0;               ///< multistart
  std::vector<std::string> parameters;  ///< profile: names
};

struct EstimationProblem {
  plant_sim::ModelFile model;
  FitDataset data;          ///< `validation_mask` may be all 0: nothing is held out
  Eigen::VectorXd weights;  ///< weights of the squared residuals in the fit
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
  /// Called by the caller's thread; may be empty.
  std::function<void(const EstimationProgress&)> progress;
};

struct EstimatedParameter {
  FreeParameter free;
  double start = 0.0;  ///< SI like the following members; the unit is in the name
  double value = 0.0;
  double std_error = 0.0;  ///< NaN at a bound, infinite where not visible
  double low = 0.0;        ///< 95 % interval
  double high = 0.0;
  int at_bound = 0;           ///< -1, 0, +1: bound reached by the value
  double record_share = 1.0;  ///< IdentifiabilityReport::share after the fit
  IntervalDoubt doubt = IntervalDoubt::none;
  bool from_profile = false;  ///< the interval is that of the profile
  bool low_found = true;      ///< false: the profile reached the bound
  bool high_found = true;
  std::vector<estimator::nonlinear::ProfilePoint> profile;  ///< SI, ascending; may be empty
};

struct MultistartCounts {
  int tried = 0;
  int same = 0;       ///< ended in the best minimum
  int elsewhere = 0;  ///< equally good within chance, at other values
  int worse = 0;
};

/// Errors of one model, measured less modelled.
struct SimulationErrors {
  double rms_m = 0.0;  ///< drift-corrected, training samples
  double heldout_rms_m = std::numeric_limits<double>::quiet_NaN();  ///< NaN: none held out
  double free_run_rms_m = 0.0;                                      ///< without correction
  double fit_percent = 0.0;                                         ///< free run
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
  Eigen::MatrixXd correlation;  ///< correlation of the estimates; NaN where undefined
  double effective_samples = 0.0;
  MultistartCounts starts;
  bool interrupted = false;
  double fit_s = 0.0;   ///< time up to the standard errors, without profiles
  int evaluations = 0;  ///< groups of eight simulations, without profiles
};

[[nodiscard]] EstimationSummary estimate(const EstimationProblem& problem,
                                         const EstimationOptions& options);

}  // namespace estimator::greybox
