#include "estimator/greybox/tracking/window_fit.h"

#include <algorithm>
#include <cmath>

#include "estimator/nonlinear/covariance.h"
#include "estimator/nonlinear/minimize.h"

namespace estimator::greybox::tracking {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kDifference = 1e-3;  ///< step of the difference quotients, search units
constexpr int kMostIterations = 12;
/// Relative cost tolerance; the cost is about the number of samples, so the rest is far below one
/// chi-square.
constexpr double kTolerance = 1e-5;
/// Initial damping: nearly a Gauss-Newton step, because successive windows start near the solution.
constexpr double kSlight = 1e-6;

Dataset room_for(std::size_t most, double sample_time_s) {
  Dataset window;
  window.sample_time_s = sample_time_s;
  window.starts = {0};
  window.t_s.assign(most, 0.0);
  window.u_V.assign(most, 0.0);
  window.y_m.assign(most, 0.0);
  window.valid.assign(most, 1);
  window.initialising.assign(most, kNotInitialising);
  return window;
}

/// Unit shape of the position error that an unknown start leaves; 0 in the lead-in.
VectorXd start_shape(const WindowData& data, double keep) {
  VectorXd shape = VectorXd::Zero(static_cast<Index>(data.lead + data.samples));
  double value = 1.0;
  if (data.gains) return shape;  // the gains know an unknown start
  for (auto k = static_cast<Index>(data.lead); k < shape.size(); ++k, value *= keep) {
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

/// Share of a residual's mean that remains at the best offset: 1 / sqrt(1 + n S^2 / sigma^2).
double left_of_mean(Index samples, const ChamberError& error, const ChamberErrors& errors) {
  const double ratio = errors.offset_sd_Pa / error.weight_Pa;
  return 1.0 / std::sqrt(1.0 + static_cast<double>(samples) * ratio * ratio);
}

/// Errors of each quantity from the residual of WindowFit::compare().
void tell_errors(const WindowData& data, const ErrorScales& errors, const VectorXd& residual,
                 WindowFitSummary& out) {
  const auto all = static_cast<Index>(data.lead + data.samples);
  const auto samples = static_cast<Index>(data.samples);
  const double square = residual.segment(all - samples, samples).squaredNorm();
  out.rms_m = std::sqrt(square / static_cast<double>(samples));
  out.position_chi_square = square / (errors.rms_m * errors.rms_m);
  if (!with_chambers(data, errors)) return;
  const auto chamber = [&](Index from, const ChamberError& error) {
    const VectorXd r = residual.segment(from, samples) * (error.weight_Pa / errors.rms_m);
    const double mean = r.mean();
    return ChamberFit{
        std::sqrt((r.array() - mean).square().mean()),
        mean / left_of_mean(samples, error, errors.chambers),
        error.weight_Pa / errors.rms_m,
    };
  };
  out.in = chamber(all, errors.chambers.in);
  out.out = chamber(all + samples, errors.chambers.out);
}

}  // namespace

WindowFit::WindowFit(const plant_sim::ModelFile& model, std::vector<FreeParameter> parameters,
                     double sample_time_s, std::size_t most, double observer_per_s)
    : observer_per_s_(observer_per_s),
      window_(room_for(most, sample_time_s)),
      run_(model, window_, std::move(parameters), observer_per_s) {}

void WindowFit::take(const WindowData& data) {
  const std::size_t all = data.lead + data.samples;
  window_.t_s.resize(all);
  window_.u_V.assign(data.u_V, data.u_V + all);
  window_.y_m.assign(data.y_m, data.y_m + all);
  window_.valid.assign(all, 1);
  window_.initialising.assign(all, kNotInitialising);
  window_.innovations = data.gains;
  std::fill_n(window_.valid.begin(), data.lead, static_cast<char>(0));
  std::fill_n(window_.initialising.begin(), data.lead, static_cast<char>(kInitialising));
}

void WindowFit::compare(const WindowData& data, const ErrorScales& errors, const MatrixXd& points,
                        MatrixXd& residuals) {
  if (!with_chambers(data, errors)) {
    run_.residuals(points, residuals);
    return;
  }
  const auto all = static_cast<Index>(data.lead + data.samples);
  const auto samples = static_cast<Index>(data.samples);
  const Index sets = points.cols();
  run_.residuals(points, position_m_, chambers_);
  residuals.resize(all + 2 * samples, sets);
  residuals.topRows(all) = position_m_;
  const auto place = [&](Index from, const double* read_Pa, const MatrixXd& model_Pa,
                         const ChamberError& error) {
    const Eigen::Map<const VectorXd> read(read_Pa + data.lead, samples);
    const double scale = errors.rms_m / error.weight_Pa;
    const double left = left_of_mean(samples, error, errors.chambers);
    for (Index set = 0; set < sets; ++set) {
      auto column = residuals.col(set).segment(from, samples);
      column = (read - model_Pa.col(set).tail(samples)).array() - error.offset_Pa;
      column.array() -= (1.0 - left) * column.mean();
      column *= scale;
    }
  };
  place(all, data.in_Pa, chambers_.in_Pa, errors.chambers.in);
  place(all + samples, data.out_Pa, chambers_.out_Pa, errors.chambers.out);
}

WindowFitSummary WindowFit::fit(const WindowData& data, const std::vector<std::size_t>& free,
                                const VectorXd& start, const ErrorScales& errors,
                                const VectorXd& prior_sd) {
  take(data);
  const VectorXd shape = start_shape(data, 1.0 - observer_per_s_ * window_.sample_time_s);
  const auto count = static_cast<Index>(free.size());
  const Index all = shape.size();
  const auto samples = static_cast<Index>(data.samples);
  estimator::nonlinear::Problem problem;
  problem.residuals = all + (with_chambers(data, errors) ? 2 * samples : 0);
  problem.lanes = ObserverSimulation::kLanes;
  problem.sigma = errors.rms_m;
  problem.weights = VectorXd::Zero(problem.residuals);
  problem.weights.tail(problem.residuals - static_cast<Index>(data.lead)).setOnes();
  VectorXd theta(count);
  for (Index i = 0; i < count; ++i) {
    const std::size_t at = free[static_cast<std::size_t>(i)];
    const FreeParameter& p = run_.parameters()[at];
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
    theta[i] = start[static_cast<Index>(at)];
  }
  MatrixXd every;
  problem.evaluate = [&](const MatrixXd& points, MatrixXd& residuals) {
    every = start.replicate(1, points.cols());
    for (Index i = 0; i < count; ++i) {
      every.row(static_cast<Index>(free[static_cast<std::size_t>(i)])) = points.row(i);
    }
    compare(data, errors, every, residuals);
    const Eigen::RowVectorXd along = shape.transpose() * residuals.topRows(all);
    residuals.topRows(all).noalias() -= shape * along;
  };
  WindowFitSummary out;
  out.theta = start;
  if (free.empty()) {
    MatrixXd residual;
    problem.evaluate(MatrixXd(0, 1), residual);
    out.chi_square = residual.squaredNorm() / (errors.rms_m * errors.rms_m);
    out.evaluations = 1;
    tell_errors(data, errors, residual.col(0), out);
    return out;
  }
  estimator::nonlinear::MinimizeOptions how;
  how.max_iterations = kMostIterations;
  how.cost_tolerance = kTolerance;
  how.first_damping = kSlight;
  const estimator::nonlinear::Solution solution = minimize(problem, theta, how);
  estimator::nonlinear::CovarianceOptions of;
  if (problem.residuals > all) of.series = {all, all + samples};
  if (data.gains) {
    of.colour = estimator::nonlinear::Colour::white;
    of.noise_sd = errors.rms_m;
  }
  const estimator::nonlinear::Covariance known = covariance(problem, solution, of);
  for (Index i = 0; i < count; ++i) {
    out.theta[static_cast<Index>(free[static_cast<std::size_t>(i)])] = solution.x[i];
  }
  out.std_error = known.std_error;
  out.covariance = known.matrix;
  out.correlation = correlation_of(known.matrix);
  const MatrixXd inner = solution.jacobian.transpose() * solution.jacobian;
  out.likeness = correlation_of(inner);
  out.at_bound = solution.at_bound;
  out.chi_square = solution.cost;
  out.evaluations = solution.evaluations;
  tell_errors(data, errors, solution.residual, out);
  if (data.gains) {
    out.residual = solution.residual;
    out.jacobian = solution.jacobian;
  }
  return out;
}

}  // namespace estimator::greybox::tracking
