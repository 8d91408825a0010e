#include "estimator/greybox/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/greybox/parallel_simulation.h"
#include "estimator/greybox/pressure_scale.h"
#include "estimator/nonlinear/covariance.h"
#include "estimator/nonlinear/minimize.h"

namespace estimator::greybox {
namespace {

constexpr double kDifference = 1e-3;  ///< step of the difference quotients, in search units
constexpr double kSettledSigma = 1.2;

}  // namespace

estimator::nonlinear::Problem problem_of(const FitDataset& data, const Eigen::VectorXd& weights,
                                         const std::vector<FreeParameter>& parameters,
                                         double logarithm_step) {
  estimator::nonlinear::Problem problem;
  problem.residuals = data.size();
  problem.lanes = ObserverSimulation::kLanes;
  problem.weights = weights;
  for (const FreeParameter& p : parameters) {
    estimator::nonlinear::Unknown unknown;
    unknown.lower = p.lower;
    unknown.upper = p.upper;
    const bool logarithm = p.scale == ParameterScale::logarithmic;
    unknown.step = logarithm ? logarithm_step : kDifference;
    unknown.relative_step = unknown.step;
    unknown.prior_mean = p.prior_mean;
    unknown.prior_sd = p.prior_sd;
    problem.unknowns.push_back(unknown);
  }
  return problem;
}

double FitSummary::value(std::string_view name) const {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].name == name)
      return parameters[i].to_physical(theta[static_cast<Eigen::Index>(i)]);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double prior_cost(const FitSummary& fitted) {
  double sum = 0.0;
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const FreeParameter& p = fitted.parameters[i];
    const double off = (fitted.theta[static_cast<Eigen::Index>(i)] - p.prior_mean) / p.prior_sd;
    if (std::isfinite(off)) sum += off * off;
  }
  return sum;
}

double correlation_factor(const Eigen::VectorXd& residual_m, const Eigen::VectorXd& weights) {
  double square = 0.0;
  double product = 0.0;
  for (Eigen::Index i = 1; i < residual_m.size(); ++i) {
    if (weights[i] == 0.0 || weights[i - 1] == 0.0) continue;
    square += residual_m[i] * residual_m[i];
    product += residual_m[i] * residual_m[i - 1];
  }
  const double rho = square > 0.0 ? std::clamp(product / square, 0.0, 0.99) : 0.0;
  return std::min((1.0 + rho) / (1.0 - rho), 100.0);
}

FitSummary fit(const plant_sim::ModelFile& model, const FitDataset& data,
               const Eigen::VectorXd& weights, const std::vector<FreeParameter>& parameters,
               const Eigen::VectorXd& start, const FitOptions& options) {
  ParallelSimulation run(model, data, parameters, options.observer_per_s, options.width);
  estimator::nonlinear::Problem problem =
      problem_of(data, weights, parameters, options.logarithm_step);
  problem.evaluate = run.evaluate();
  problem.lanes = run.lanes();
  estimator::nonlinear::MinimizeOptions how;
  how.cost_tolerance = options.tolerance;
  how.renew_all = false;
  how.final_jacobian = false;
  how.cancel = options.cancel;
  how.max_iterations = options.max_iterations;
  Eigen::VectorXd theta = start;
  Eigen::MatrixXd first_m;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    theta[k] = std::clamp(theta[k], parameters[i].lower, parameters[i].upper);
  }
  if (options.start_residual_m.size() > 0) {
    how.start_residual = options.start_residual_m;
    how.start_jacobian = options.start_jacobian;
  } else {
    run.residuals(theta, first_m);
    how.start_residual = first_m.col(0);
  }
  const auto sigma_of = [&](const Eigen::VectorXd& residual_m) {
    return std::max({data.noise_floor_m, rms(residual_m, weights), kLeastFloor_m}) *
           std::sqrt(correlation_factor(residual_m, weights));
  };
  FitSummary result;
  result.parameters = parameters;
  result.evaluations = 1;
  problem.sigma = sigma_of(how.start_residual);
  for (int pass = 0; pass < options.passes; ++pass) {
    how.final_jacobian = options.final_jacobian && pass + 1 == options.passes;
    estimator::nonlinear::Solution solution = minimize(problem, theta, how);
    result.evaluations += solution.evaluations;
    const double sigma_m = problem.sigma;
    problem.sigma = sigma_of(solution.residual);
    const bool last = pass + 1 == options.passes || (problem.sigma < kSettledSigma * sigma_m &&
                                                     sigma_m < kSettledSigma * problem.sigma);
    theta = solution.x;
    how.start_residual = solution.residual;
    how.start_jacobian = solution.jacobian;
    if (!last) continue;
    if (options.final_jacobian && !how.final_jacobian) {
      how.final_jacobian = true;
      how.max_iterations = 2;
      solution = minimize(problem, theta, how);
      result.evaluations += solution.evaluations;
    }
    result.theta = solution.x;
    result.residual_m = std::move(solution.residual);
    result.jacobian = std::move(solution.jacobian);
    result.at_bound = std::move(solution.at_bound);
    result.cost = solution.cost;
    result.sigma_m = problem.sigma;
    break;
  }
  clear_pressure_scale(model, result);
  result.training_rms_m = rms(result.residual_m, weights);
  result.validation_rms_m = rms(result.residual_m, data.validation_mask);
  return result;
}

Eigen::VectorXd std_errors(const FitDataset& data, const Eigen::VectorXd& weights,
                           const FitSummary& fitted) {
  if (fitted.jacobian.size() == 0) {  // fit cancelled before its first Jacobian
    return Eigen::VectorXd::Constant(fitted.theta.size(), std::numeric_limits<double>::quiet_NaN());
  }
  estimator::nonlinear::Problem problem = problem_of(data, weights, fitted.parameters);
  problem.sigma = fitted.sigma_m;
  estimator::nonlinear::Solution solution;
  solution.x = fitted.theta;
  solution.residual = fitted.residual_m;
  solution.jacobian = fitted.jacobian;
  solution.at_bound = fitted.at_bound;
  return estimator::nonlinear::covariance(problem, solution).std_error;
}

plant_sim::ModelFile with_values(plant_sim::ModelFile model, const FitSummary& fitted) {
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const FreeParameter& p = fitted.parameters[i];
    if (double* value = model.value(p.name)) {
      *value = p.to_physical(fitted.theta[static_cast<Eigen::Index>(i)]);
    }
  }
  return model;
}

}  // namespace estimator::greybox
