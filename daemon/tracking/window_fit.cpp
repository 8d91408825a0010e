#include "daemon/tracking/window_fit.h"

#include <algorithm>
#include <cmath>

#include "estimator/nonlinear/covariance.h"
#include "estimator/nonlinear/minimize.h"

namespace monitor::tracking {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kDifference = 1e-3;  ///< step of the difference quotients, search units
constexpr int kMostIterations = 12;
/// Of the cost, about the number of samples: what is left to gain is far below one chi-square.
constexpr double kTolerance = 1e-5;
/// Nearly Gauss and Newton's step: windows follow each other, the start is near.
constexpr double kSlight = 1e-6;

Measured room_for(std::size_t most, double sample_time_s) {
  Measured window;
  window.sample_time_s = sample_time_s;
  window.starts = {0};
  window.t_s.assign(most, 0.0);
  window.u_V.assign(most, 0.0);
  window.y_m.assign(most, 0.0);
  window.settled.assign(most, 1);
  window.led.assign(most, kNotLed);
  return window;
}

/// What the position at the window's start leaves, of length one; 0 in the lead-in.
VectorXd start_shape(const Cut& cut, double keep) {
  VectorXd shape = VectorXd::Zero(static_cast<Index>(cut.lead + cut.samples));
  double value = 1.0;
  for (auto k = static_cast<Index>(cut.lead); k < shape.size(); ++k, value *= keep) {
    shape[k] = value;
  }
  return shape.normalized();
}

MatrixXd correlation_of(const MatrixXd& covariance) {
  MatrixXd out = covariance;
  for (Index i = 0; i < out.rows(); ++i) {
    for (Index j = 0; j < out.cols(); ++j) {
      const double scale = std::sqrt(covariance(i, i) * covariance(j, j));
      out(i, j) = scale > 0.0 ? covariance(i, j) / scale : (i == j ? 1.0 : 0.0);
    }
  }
  return out;
}

}  // namespace

WindowFit::WindowFit(const plant_sim::ModelFile& model, std::vector<SearchParameter> parameters,
                     double sample_time_s, std::size_t most, double observer_per_s)
    : observer_per_s_(observer_per_s),
      window_(room_for(most, sample_time_s)),
      run_(model, window_, std::move(parameters), observer_per_s) {}

void WindowFit::take(const Cut& cut) {
  const std::size_t all = cut.lead + cut.samples;
  window_.t_s.resize(all);
  window_.u_V.assign(cut.u_V, cut.u_V + all);
  window_.y_m.assign(cut.y_m, cut.y_m + all);
  window_.settled.assign(all, 1);
  window_.led.assign(all, kNotLed);
  std::fill_n(window_.settled.begin(), cut.lead, static_cast<char>(0));
  std::fill_n(window_.led.begin(), cut.lead, static_cast<char>(kLed));
}

WindowEstimate WindowFit::fit(const Cut& cut, const std::vector<std::size_t>& free,
                              const VectorXd& start, double sigma_m, const VectorXd& prior_sd) {
  take(cut);
  const VectorXd shape = start_shape(cut, 1.0 - observer_per_s_ * window_.sample_time_s);
  const auto count = static_cast<Index>(free.size());
  estimator::nonlinear::Problem problem;
  problem.residuals = shape.size();
  problem.lanes = ModelRun::kLanes;
  problem.sigma = sigma_m;
  problem.weights = VectorXd::Zero(shape.size());
  problem.weights.tail(static_cast<Index>(cut.samples)).setOnes();
  VectorXd x(count);
  for (Index i = 0; i < count; ++i) {
    const std::size_t at = free[static_cast<std::size_t>(i)];
    const SearchParameter& p = run_.searched()[at];
    estimator::nonlinear::Unknown unknown;
    unknown.lower = p.lower;
    unknown.upper = p.upper;
    unknown.step = kDifference;
    unknown.relative_step = kDifference;
    if (prior_sd.size() > 0) {
      unknown.prior_mean = start[static_cast<Index>(at)];
      unknown.prior_sd = prior_sd[static_cast<Index>(at)];
    }
    problem.unknowns.push_back(unknown);
    x[i] = start[static_cast<Index>(at)];
  }
  MatrixXd every;
  problem.evaluate = [&](const MatrixXd& points, MatrixXd& residuals_m) {
    every = start.replicate(1, points.cols());
    for (Index i = 0; i < count; ++i) {
      every.row(static_cast<Index>(free[static_cast<std::size_t>(i)])) = points.row(i);
    }
    run_.residuals(every, residuals_m);
    const Eigen::RowVectorXd along = shape.transpose() * residuals_m;
    residuals_m.noalias() -= shape * along;
  };
  WindowEstimate out;
  out.x = start;
  if (free.empty()) {
    MatrixXd residual_m;
    problem.evaluate(MatrixXd(0, 1), residual_m);
    out.chi_square = residual_m.squaredNorm() / (sigma_m * sigma_m);
    out.rms_m = std::sqrt(residual_m.squaredNorm() / static_cast<double>(cut.samples));
    out.evaluations = 1;
    return out;
  }
  estimator::nonlinear::Options how;
  how.max_iterations = kMostIterations;
  how.cost_tolerance = kTolerance;
  how.first_damping = kSlight;
  const estimator::nonlinear::Solution solution = minimize(problem, x, how);
  const estimator::nonlinear::Covariance known = covariance(problem, solution);
  for (Index i = 0; i < count; ++i) {
    out.x[static_cast<Index>(free[static_cast<std::size_t>(i)])] = solution.x[i];
  }
  out.std_error = known.std_error;
  out.covariance = known.matrix;
  out.correlation = correlation_of(known.matrix);
  const MatrixXd inner = solution.jacobian.transpose() * solution.jacobian;
  out.likeness = correlation_of(inner);
  out.at_bound = solution.at_bound;
  out.rms_m = solution.rms;
  out.chi_square = solution.cost;
  out.evaluations = solution.evaluations;
  return out;
}

}  // namespace monitor::tracking
