// A model's parameters fitted to evidence.
//
//   min  sum r(k)^2 / (c s^2)  +  sum ((x - mean) / sd)^2
//
// r measured less modelled position of the fitted samples; s their RMS, not under the noise floor;
// c by how much neighbouring errors hang together, (1 + rho) / (1 - rho). While a model is wrong
// its errors are large and slow: the less the record says, the more the priors do.
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

/// Step of the difference quotients of logarithmic parameters: large enough for models with dry
/// friction, whose cost is ragged.
inline constexpr double kLogarithmStep = 1e-3;

struct FitOptions {
  int max_iterations = 30;
  double tolerance = 1e-4;     ///< relative decrease of the cost at which it ends
  int passes = 3;              ///< at most; each weighs the residual anew
  bool final_jacobian = true;  ///< false: FitSummary::jacobian may be stale in some columns
  double observer_per_s = kObserver_per_s;
  std::function<bool()> cancel;  ///< true ends the search, keeping the best so far
  Width width;                   ///< of the evaluations
  double logarithm_step = kLogarithmStep;
  // Of the start, where known already; otherwise empty.
  Eigen::VectorXd start_residual_m;
  Eigen::MatrixXd start_jacobian;
};

struct FitSummary {
  std::vector<FreeParameter> parameters;
  Eigen::VectorXd theta;       ///< search values
  Eigen::VectorXd residual_m;  ///< of all samples
  Eigen::MatrixXd jacobian;    ///< d residual / d x, all samples
  std::vector<int> at_bound;   ///< -1, 0, +1 for each parameter
  double training_rms_m = 0.0;
  double validation_rms_m = 0.0;
  double cost = 0.0;
  double sigma_m = 0.0;  ///< s sqrt(c) of the last pass
  int evaluations = 0;   ///< groups of eight simulations

  /// The value found for a parameter, NaN when it was not searched.
  [[nodiscard]] double value(std::string_view name) const;
};

/// What fit() minimises; `evaluate`, `lanes` and `sigma` are left to the caller.
[[nodiscard]] estimator::nonlinear::Problem problem_of(const FitDataset& data,
                                                       const Eigen::VectorXd& weights,
                                                       const std::vector<FreeParameter>& parameters,
                                                       double logarithm_step = kLogarithmStep);

/// Weights: which samples count in the fit (Evidence::fits, or counts for the final values).
[[nodiscard]] FitSummary fit(const plant_sim::ModelFile& model, const FitDataset& data,
                             const Eigen::VectorXd& weights,
                             const std::vector<FreeParameter>& parameters,
                             const Eigen::VectorXd& start, const FitOptions& options = {});

/// Standard error of each search value, honest for residuals of any colour; NaN at a bound,
/// infinite where neither record nor prior sees it. `weights` as in the fit.
[[nodiscard]] Eigen::VectorXd std_errors(const FitDataset& data, const Eigen::VectorXd& weights,
                                         const FitSummary& fitted);

/// (1 + rho) / (1 - rho) with the residual's correlation rho from one sample to the next, within
/// 1 to 100.
[[nodiscard]] double correlation_factor(const Eigen::VectorXd& residual_m,
                                        const Eigen::VectorXd& weights);

/// The model with the values found; effects whose parameters were searched become present.
[[nodiscard]] plant_sim::ModelFile with_values(plant_sim::ModelFile model,
                                               const FitSummary& fitted);

}  // namespace estimator::greybox
