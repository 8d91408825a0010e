#include "estimator/greybox/selection/step_error.h"

#include <cmath>

#include "estimator/greybox/dataset_simulation.h"
#include "estimator/linear_algebra/decompositions.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Share of the integration step that is held against it.
constexpr double kFinerStep = 0.25;
constexpr double kLeastStep_s = 1e-6;  ///< a model file's
/// Errors over the noise between which a finer step is tried, and the share of the error that the
/// change of step has at least: it also moves a fit from one minimum to another.
constexpr double kMoreThanNoise = 1.2;
constexpr double kNearNoise = 10.0;
constexpr double kByStep = 0.1;

VectorXd residuals(const plant_sim::ModelFile& model, const FitDataset& data,
                   const FitSummary& fitted, double observer_per_s) {
  DatasetSimulation run(model, data, fitted.parameters, observer_per_s);
  MatrixXd residual_m;
  run.residuals(fitted.theta, residual_m);
  return residual_m.col(0);
}

}  // namespace

StepError step_error(const SearchContext& context, const FitSummary& fitted,
                     const VectorXd& weights, double observer_per_s) {
  StepError result;
  const Index count = fitted.theta.size();
  result.shift = VectorXd::Zero(count);
  if (context.cancelled() || fitted.jacobian.cols() != count) return result;
  const FitDataset& data = context.problem.data;
  plant_sim::ModelFile finer = context.problem.model;
  finer.step_s *= kFinerStep;
  const VectorXd change_m = residuals(finer, data, fitted, observer_per_s) -
                            residuals(context.problem.model, data, fitted, observer_per_s);
  if (!change_m.allFinite()) return result;
  FitDataset plain = data;  // a predictor corrects most of the change
  for (Dataset& record : plain.records) record.innovations.reset();
  result.rms_m = rms(residuals(finer, plain, fitted, observer_per_s) -
                         residuals(context.problem.model, plain, fitted, observer_per_s),
                     weights);
  // J shift = change, beside the priors
  const Index samples = change_m.size();
  MatrixXd left = MatrixXd::Zero(samples + count, count);
  VectorXd right = VectorXd::Zero(samples + count);
  const VectorXd root = weights.cwiseSqrt() / fitted.sigma_m;
  right.head(samples) = root.cwiseProduct(change_m);
  for (Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (fitted.at_bound[at] != 0) continue;
    left.col(i).head(samples) = root.cwiseProduct(fitted.jacobian.col(i));
    const double prior_sd = fitted.parameters[at].prior_sd;
    if (prior_sd > 0.0 && std::isfinite(prior_sd)) left(samples + i, i) = 1.0 / prior_sd;
  }
  result.shift = linear_algebra::shortest_least_squares(left, right).x;
  return result;
}

bool may_be_step_error(const SearchContext& context, const FitSummary& fitted) {
  const FitDataset& data = context.problem.data;
  const double left_m = fitted.validation_rms_m;
  return left_m > kMoreThanNoise * data.noise_floor_m && left_m < kNearNoise * data.noise_floor_m &&
         step_error(context, fitted, data.validation_mask, kObserver_per_s).rms_m >
             kByStep * left_m;
}

std::optional<DiagnosisProblem> with_finer_step(const DiagnosisProblem& problem) {
  DiagnosisProblem finer = problem;
  finer.model.step_s *= kFinerStep;
  if (finer.model.step_s < kLeastStep_s) return {};
  return finer;
}

}  // namespace estimator::greybox::selection
