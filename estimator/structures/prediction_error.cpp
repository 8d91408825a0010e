#include "estimator/structures/prediction_error.h"

#include <algorithm>
#include <cmath>

#include "config/signals/nan.h"
#include "estimator/linear_algebra/decompositions.h"
#include "estimator/nonlinear/covariance.h"
#include "estimator/nonlinear/minimize.h"
#include "estimator/structures/linear.h"

namespace estimator::structures {
namespace {

using config::signals::kNaN;

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kPredictionStep =
    1e-8;  // step of a coefficient about 1; w of an integrator is n times as sensitive
constexpr int kRowsPerCoefficient = 3;
constexpr double kTolerance = 1e-9;

nonlinear::Problem problem_of(const Orders& orders, const Stretches& data) {
  nonlinear::Problem out;
  const int first = orders.history();
  for (const Stretch& stretch : data) out.residuals += std::max(0, stretch.size() - first);
  const double y = std::max(rms(data, false), 1e-300);
  const double u = std::max(rms(data, true), 1e-300);
  for (int j = 0; j < orders.size(); ++j) {
    nonlinear::Unknown unknown;
    unknown.relative_step = 0.0;
    unknown.step = kPredictionStep;
    if (j >= orders.a && j < orders.a + orders.b) unknown.step = kPredictionStep * y / u;
    if (orders.constant && j == orders.size() - 1) unknown.step = kPredictionStep * y;
    out.unknowns.push_back(unknown);
  }
  out.evaluate = [orders, &data, first](const MatrixXd& points, MatrixXd& residuals) {
    for (Index column = 0; column < points.cols(); ++column) {
      const VectorXd x = points.col(column);
      const Polynomial model = from_values(orders, x.data());
      Index row = 0;
      for (const Stretch& stretch : data) {
        const std::vector<double> e = one_step_errors(model, stretch);
        for (int t = first; t < stretch.size(); ++t) residuals(row++, column) = e[t];
      }
    }
  };
  return out;
}

double energy(const nonlinear::Problem& problem, const VectorXd& x) {
  MatrixXd residuals(problem.residuals, 1);
  problem.evaluate(x, residuals);
  const double sum = residuals.squaredNorm();
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

/// Output-error and Box-Jenkins starts have B, F and perhaps a constant that is not settled yet.
std::vector<Polynomial> usual_starts(const Orders& orders, const Stretches& data,
                                     const PredictionErrorOptions& options) {
  std::vector<Polynomial> out;
  const bool has_noise_model = orders.c > 0 || orders.d > 0;
  if (orders.f == 0 && orders.d == 0) {
    out.push_back(hannan_rissanen(orders, data));
    Polynomial plain = fit_arx(orders, data);
    plain.c.assign(static_cast<std::size_t>(orders.c), 0.0);
    out.push_back(plain);
    return out;
  }
  if (!has_noise_model) return steiglitz_mcbride(orders, data);
  Orders output_error = orders;
  output_error.c = output_error.d = 0;
  PredictionErrorOptions inner = options;
  inner.starts.clear();
  inner.only_these_starts = false;
  inner.errors = false;
  const PolynomialFit oe = fit_prediction_error(output_error, data, inner);
  if (oe.valid) {
    std::vector<std::vector<double>> v;
    for (const Stretch& stretch : data) {
      std::vector<double> e = one_step_errors(oe.model, stretch);
      e.erase(e.begin(), e.begin() + output_error.history());
      v.push_back(std::move(e));
    }
    const ArmaModel noise = fit_noise(v, orders.c, orders.d);
    Polynomial start = oe.model;
    start.c = noise.c;
    start.d = noise.d;
    out.push_back(start);
  }
  const Orders equation{
      .a = orders.f, .b = orders.b, .c = orders.c, .k = orders.k, .constant = orders.constant};
  const PolynomialFit armax = fit_prediction_error(equation, data, inner);
  if (armax.valid) {
    Polynomial start = armax.model;
    start.f = start.a;
    start.d = stabilised(start.a, 1e-3);
    start.d.resize(static_cast<std::size_t>(orders.d), 0.0);
    start.a.clear();
    out.push_back(start);
  }
  return out;
}

double scaled_condition(const MatrixXd& jacobian) {
  MatrixXd upper = linear_algebra::upper_triangle(jacobian);
  for (Index j = 0; j < upper.cols(); ++j) {
    const double length = upper.col(j).norm();
    if (!(length > 0.0)) return std::numeric_limits<double>::infinity();
    upper.col(j) /= length;
  }
  const VectorXd s = linear_algebra::singular_values(upper);
  return s[0] / s[s.size() - 1];
}

PolynomialFit refused(const Orders& orders, const std::string& why) {
  PolynomialFit out;
  out.orders = orders;
  out.value.assign(static_cast<std::size_t>(orders.size()), kNaN);
  out.std_error = out.value;
  out.condition = out.residual_rms_m = kNaN;
  out.why = why;
  return out;
}

nonlinear::Solution best_of(const nonlinear::Problem& problem, const std::vector<VectorXd>& starts,
                            const PredictionErrorOptions& options) {
  nonlinear::MinimizeOptions search;
  search.max_iterations = options.max_iterations;
  search.cost_tolerance = kTolerance;
  search.cancel = options.cancel;
  nonlinear::Solution best;
  best.cost = std::numeric_limits<double>::infinity();
  for (const VectorXd& start : starts) {
    nonlinear::Solution solution = nonlinear::minimize(problem, start, search);
    const bool usable = solution.reason != nonlinear::StopReason::start_not_finite;
    if (usable && solution.cost < best.cost) best = std::move(solution);
  }
  return best;
}

}  // namespace

int least_samples(const Orders& orders) {
  return orders.history() + kRowsPerCoefficient * orders.size() + 10;
}

PolynomialFit fit_prediction_error(const Orders& orders, const Stretches& all,
                                   const PredictionErrorOptions& options) {
  Stretches data;
  for (const Stretch& stretch : all) {
    if (stretch.size() >= least_samples(orders)) data.push_back(stretch);
  }
  if (data.empty()) return refused(orders, "too few samples");
  if (!(rms(data, true) > 0.0) && orders.b > 0) return refused(orders, "the input is zero");
  nonlinear::Problem problem = problem_of(orders, data);
  std::vector<Polynomial> models = options.starts;
  if (!options.only_these_starts) {
    for (Polynomial& model : usual_starts(orders, data, options)) models.push_back(model);
  }
  std::vector<VectorXd> starts;
  for (const Polynomial& model : models) {
    const std::vector<double> values = to_values(model, orders.constant);
    if (static_cast<int>(values.size()) != orders.size()) continue;
    starts.emplace_back(Eigen::Map<const VectorXd>(values.data(), orders.size()));
  }
  double least = std::numeric_limits<double>::infinity();
  for (const VectorXd& start : starts) least = std::min(least, energy(problem, start));
  if (!std::isfinite(least)) return refused(orders, "no start that stays finite");
  if (least == 0.0) least = 1e-300;
  problem.sigma = std::sqrt(least / static_cast<double>(problem.residuals));
  const nonlinear::Solution solution = best_of(problem, starts, options);
  if (!std::isfinite(solution.cost)) return refused(orders, "the search did not stay finite");

  PolynomialFit out;
  out.orders = orders;
  out.model = from_values(orders, solution.x.data());
  out.value.assign(solution.x.begin(), solution.x.end());
  out.residual_rms_m = solution.rms;
  out.samples = static_cast<int>(problem.residuals);
  out.starts = static_cast<int>(starts.size());
  out.converged = solution.converged;
  out.valid = true;
  out.std_error.assign(out.value.size(), kNaN);
  out.condition = kNaN;
  if (options.errors) {
    nonlinear::CovarianceOptions how;
    how.colour = orders.c > 0 || orders.d > 0 || orders.f == 0 ? nonlinear::Colour::white
                                                               : nonlinear::Colour::coloured;
    const VectorXd errors = nonlinear::covariance(problem, solution, how).std_error;
    out.std_error.assign(errors.begin(), errors.end());
    out.condition = scaled_condition(solution.jacobian);
  }
  return out;
}

}  // namespace estimator::structures
