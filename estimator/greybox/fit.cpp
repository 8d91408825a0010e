#include "estimator/greybox/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/greybox/parallel_simulation.h"
#include "estimator/nonlinear/covariance.h"
#include "estimator/nonlinear/minimize.h"

namespace estimator::greybox {
namespace {

constexpr double kDifference = 1e-3;  ///< step of the difference quotients, in search units
constexpr double kSameSigma = 1.2;

}  // namespace

estimator::nonlinear::Problem problem_of(const Evidence& evidence, const Eigen::VectorXd& weights,
                                         const std::vector<SearchParameter>& searched,
                                         double logarithm_step) {
  estimator::nonlinear::Problem problem;
  problem.residuals = evidence.size();
  problem.lanes = ModelRun::kLanes;
  problem.weights = weights;
  for (const SearchParameter& p : searched) {
    estimator::nonlinear::Unknown unknown;
    unknown.lower = p.lower;
    unknown.upper = p.upper;
    const bool logarithm = p.scale == Scale::logarithmic;
    unknown.step = logarithm ? logarithm_step : kDifference;
    unknown.relative_step = unknown.step;
    unknown.prior_mean = p.prior_mean;
    unknown.prior_sd = p.prior_sd;
    problem.unknowns.push_back(unknown);
  }
  return problem;
}

EvidenceRun::EvidenceRun(const plant_sim::ModelFile& model, const Evidence& evidence,
                         const std::vector<SearchParameter>& searched, double observer_per_s) {
  runs_.reserve(evidence.records.size());
  for (const Measured& record : evidence.records) {
    runs_.emplace_back(model, record, searched, observer_per_s);
    sizes_.push_back(static_cast<Eigen::Index>(record.size()));
  }
}

void EvidenceRun::residuals(const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals_m) {
  residuals(points, {}, {}, residuals_m);
}

void EvidenceRun::residuals(const Eigen::MatrixXd& points, const Eigen::MatrixXd& added_V,
                            const Eigen::MatrixXd& added_N, Eigen::MatrixXd& residuals_m) {
  if (runs_.size() == 1) {
    runs_.front().residuals(points, added_V, added_N, residuals_m);
    return;
  }
  Eigen::Index total = 0;
  for (const Eigen::Index size : sizes_) total += size;
  residuals_m.resize(total, points.cols());
  Eigen::MatrixXd one_m;
  Eigen::Index at = 0;
  const auto rows = [&](const Eigen::MatrixXd& added, Eigen::Index size) -> Eigen::MatrixXd {
    if (added.size() == 0) return {};
    return added.middleRows(at, size);
  };
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    runs_[i].residuals(points, rows(added_V, sizes_[i]), rows(added_N, sizes_[i]), one_m);
    residuals_m.middleRows(at, sizes_[i]) = one_m;
    at += sizes_[i];
  }
}

double Fitted::value(std::string_view name) const {
  for (std::size_t i = 0; i < searched.size(); ++i) {
    if (searched[i].name == name) return searched[i].value(x[static_cast<Eigen::Index>(i)]);
  }
  return std::numeric_limits<double>::quiet_NaN();
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

Fitted fit(const plant_sim::ModelFile& model, const Evidence& evidence,
           const Eigen::VectorXd& weights, const std::vector<SearchParameter>& searched,
           const Eigen::VectorXd& start, const FitOptions& options) {
  WideRun run(model, evidence, searched, options.observer_per_s, options.threads);
  estimator::nonlinear::Problem problem =
      problem_of(evidence, weights, searched, options.logarithm_step);
  problem.evaluate = run.evaluate();
  problem.lanes = run.lanes();
  estimator::nonlinear::Options how;
  how.cost_tolerance = options.tolerance;
  how.renew_all = false;
  how.final_jacobian = false;
  how.cancel = options.cancel;
  how.max_iterations = options.max_iterations;
  Eigen::VectorXd x = start;
  Eigen::MatrixXd first_m;
  for (std::size_t i = 0; i < searched.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    x[k] = std::clamp(x[k], searched[i].lower, searched[i].upper);
  }
  if (options.start_residual_m.size() > 0) {
    how.start_residual = options.start_residual_m;
    how.start_jacobian = options.start_jacobian;
  } else {
    run.residuals(x, first_m);
    how.start_residual = first_m.col(0);
  }
  const auto sigma_of = [&](const Eigen::VectorXd& residual_m) {
    return std::max(evidence.noise_floor_m, rms(residual_m, weights)) *
           std::sqrt(correlation_factor(residual_m, weights));
  };
  Fitted result;
  result.searched = searched;
  result.evaluations = 1;
  problem.sigma = sigma_of(how.start_residual);
  for (int pass = 0; pass < options.passes; ++pass) {
    how.final_jacobian = options.final_jacobian && pass + 1 == options.passes;
    estimator::nonlinear::Solution solution = minimize(problem, x, how);
    result.evaluations += solution.evaluations;
    const double sigma_m = problem.sigma;
    problem.sigma = sigma_of(solution.residual);
    const bool last = pass + 1 == options.passes || (problem.sigma < kSameSigma * sigma_m &&
                                                     sigma_m < kSameSigma * problem.sigma);
    x = solution.x;
    how.start_residual = solution.residual;
    how.start_jacobian = solution.jacobian;
    if (!last) continue;
    if (options.final_jacobian && !how.final_jacobian) {
      how.final_jacobian = true;
      how.max_iterations = 2;
      solution = minimize(problem, x, how);
      result.evaluations += solution.evaluations;
    }
    result.x = solution.x;
    result.residual_m = std::move(solution.residual);
    result.jacobian = std::move(solution.jacobian);
    result.at_bound = std::move(solution.at_bound);
    result.cost = solution.cost;
    result.sigma_m = problem.sigma;
    break;
  }
  result.fit_rms_m = rms(result.residual_m, weights);
  result.score_rms_m = rms(result.residual_m, evidence.scores);
  return result;
}

Eigen::VectorXd std_errors(const Evidence& evidence, const Eigen::VectorXd& weights,
                           const Fitted& fitted) {
  if (fitted.jacobian.size() == 0) {  // of a fit that was ended before it had one
    return Eigen::VectorXd::Constant(fitted.x.size(), std::numeric_limits<double>::quiet_NaN());
  }
  estimator::nonlinear::Problem problem = problem_of(evidence, weights, fitted.searched);
  problem.sigma = fitted.sigma_m;
  estimator::nonlinear::Solution solution;
  solution.x = fitted.x;
  solution.residual = fitted.residual_m;
  solution.jacobian = fitted.jacobian;
  solution.at_bound = fitted.at_bound;
  return estimator::nonlinear::covariance(problem, solution).std_error;
}

plant_sim::ModelFile with_values(plant_sim::ModelFile model, const Fitted& fitted) {
  for (std::size_t i = 0; i < fitted.searched.size(); ++i) {
    const SearchParameter& p = fitted.searched[i];
    if (double* value = model.value(p.name)) {
      *value = p.value(fitted.x[static_cast<Eigen::Index>(i)]);
    }
  }
  return model;
}

}  // namespace estimator::greybox
