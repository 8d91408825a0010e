// Fit of a model's parameters to a data set.
//
//   min  sum r(k)^2 / (c s^2)  +  sum ((theta - mean) / sd)^2
//
// r measured less modelled position of the training samples; s their RMS, at least the noise floor;
// c inflation for lag-1 autocorrelation, (1 + rho) / (1 - rho). The errors of a wrong model are
// large and slow, which lowers the weight of the record relative to the priors.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "estimator/greybox/dataset_simulation.h"
#include "estimator/greybox/fit_dataset.h"
#include "estimator/greybox/free_parameter.h"
#include "estimator/greybox/observer_simulation.h"
#include "estimator/greybox/parallel_simulation.h"
#include "estimator/nonlinear/problem.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox {

/// Difference step of logarithmic parameters: large enough for models with dry friction, whose cost
/// is discontinuous.
inline constexpr double kLogarithmStep = 1e-3;

struct FitOptions {
  int max_iterations = 30;
  double tolerance = 1e-4;     ///< relative decrease of the cost at convergence
  int passes = 3;              ///< upper limit; each pass weights the residual again
  bool final_jacobian = true;  ///< false: FitSummary::jacobian may be stale in some columns
  double observer_per_s = kObserver_per_s;
  std::function<bool()> cancel;  ///< true ends the search, keeping the best so far
  SimulationWidth width;         ///< width of the evaluations
  double logarithm_step = kLogarithmStep;
  // Residual at the start, where already known; otherwise empty.
  Eigen::VectorXd start_residual_m;
  Eigen::MatrixXd start_jacobian;
};

struct FitSummary {
  std::vector<FreeParameter> parameters;
  Eigen::VectorXd theta;       ///< search values
  Eigen::VectorXd residual_m;  ///< all samples
  Eigen::MatrixXd jacobian;    ///< d residual / d theta, all samples
  std::vector<int> at_bound;   ///< -1, 0, +1 per parameter
  double training_rms_m = 0.0;
  double validation_rms_m = 0.0;
  double cost = 0.0;
  double sigma_m = 0.0;  ///< s sqrt(c) of the last pass
  int evaluations = 0;   ///< groups of eight simulations

  /// Value of a fitted parameter; NaN for any other.
  [[nodiscard]] double value(std::string_view name) const;
};

/// Problem that fit() minimises; the caller sets `evaluate`, `lanes` and `sigma`.
[[nodiscard]] estimator::nonlinear::Problem problem_of(const FitDataset& data,
                                                       const Eigen::VectorXd& weights,
                                                       const std::vector<FreeParameter>& parameters,
                                                       double logarithm_step = kLogarithmStep);

/// `weights`: samples that count in the fit (FitDataset::training_mask, or all_mask for final
/// values).
[[nodiscard]] FitSummary fit(const plant_sim::ModelFile& model, const FitDataset& data,
                             const Eigen::VectorXd& weights,
                             const std::vector<FreeParameter>& parameters,
                             const Eigen::VectorXd& start, const FitOptions& options = {});

/// Standard error of each theta, valid for coloured residuals; NaN at a bound, infinite where
/// neither record nor prior determines it. `weights` as in the fit.
[[nodiscard]] Eigen::VectorXd std_errors(const FitDataset& data, const Eigen::VectorXd& weights,
                                         const FitSummary& fitted);

/// sum ((theta - mean) / sd)^2 over the parameters with a prior.
[[nodiscard]] double prior_cost(const FitSummary& fitted);

/// (1 + rho) / (1 - rho) with the residual's lag-1 autocorrelation rho; within 1 to 100.
[[nodiscard]] double correlation_factor(const Eigen::VectorXd& residual_m,
                                        const Eigen::VectorXd& weights);

/// The model with the fitted values; effects with fitted parameters become present.
[[nodiscard]] plant_sim::ModelFile with_values(plant_sim::ModelFile model,
                                               const FitSummary& fitted);

}  // namespace estimator::greybox
