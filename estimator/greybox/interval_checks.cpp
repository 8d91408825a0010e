#include "estimator/greybox/interval_checks.h"

#include <algorithm>
#include <cmath>

#include "estimator/greybox/parallel_simulation.h"
#include "estimator/nonlinear/difference.h"
#include "estimator/nonlinear/linear_model.h"
#include "estimator/parallel.h"

namespace estimator::greybox {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using estimator::nonlinear::Covariance;
using estimator::nonlinear::Problem;
using estimator::nonlinear::Profile;
using estimator::nonlinear::ProfileOptions;
using estimator::nonlinear::Solution;
using estimator::nonlinear::Standing;

constexpr double kInterval = 1.96;
constexpr double kLargeLogarithm = 0.2;
constexpr double kLargeShare = 0.3;
/// Allowed deviation from the rise of a parabola, as a share of that rise.
constexpr double kBent = 0.4;
constexpr double kSeen = 0.5;

bool is_large(const FreeParameter& p, double theta, double std_error) {
  return std_error >
         (p.scale == ParameterScale::logarithmic ? kLargeLogarithm : kLargeShare * std::abs(theta));
}

/// Marks parameters whose cost at the ends of their intervals differs from the linear model's.
void check_curvature(const Problem& problem, const Solution& solution, const Covariance& known,
                     std::vector<IntervalDoubt>& found) {
  const Index n = problem.size();
  const auto model =
      estimator::nonlinear::compress(problem, solution.x, solution.residual, solution.jacobian);
  struct End {
    Index j;
    VectorXd step;
  };
  std::vector<End> ends;
  for (Index j = 0; j < n; ++j) {
    if (known.standing[static_cast<std::size_t>(j)] != Standing::estimated) continue;
    const double variance = known.matrix(j, j);
    if (found[static_cast<std::size_t>(j)] != IntervalDoubt::none || !(variance > 0.0)) continue;
    for (const double side : {-kInterval, kInterval}) {
      VectorXd step = side / std::sqrt(variance) * known.matrix.col(j);
      for (Index i = 0; i < n; ++i) {
        const auto& u = problem.unknowns[static_cast<std::size_t>(i)];
        step[i] = std::clamp(step[i], u.lower - solution.x[i], u.upper - solution.x[i]);
      }
      ends.push_back({j, step});
    }
  }
  if (ends.empty()) return;
  Eigen::MatrixXd points(n, static_cast<Index>(ends.size()));
  for (std::size_t i = 0; i < ends.size(); ++i) {
    points.col(static_cast<Index>(i)) = solution.x + ends[i].step;
  }
  estimator::nonlinear::Groups groups(problem);
  const Eigen::MatrixXd results = groups.run(points);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const auto column = static_cast<Index>(i);
    const double rise =
        estimator::nonlinear::cost_of(problem, points.col(column), results.col(column)) -
        solution.cost;
    const double expected = -estimator::nonlinear::predicted_decrease(model, ends[i].step);
    // The cost rises little where a bound cuts the interval; the profile shows that as well.
    if (!(std::abs(rise - expected) < kBent * std::max(expected, 1.0))) {
      found[static_cast<std::size_t>(ends[i].j)] = IntervalDoubt::not_quadratic;
    }
  }
}

}  // namespace

std::vector<IntervalDoubt> doubts(const Problem& problem, const Solution& solution,
                                  const Covariance& known,
                                  const std::vector<FreeParameter>& parameters,
                                  const VectorXd& record_share) {
  std::vector<IntervalDoubt> found(parameters.size(), IntervalDoubt::none);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto j = static_cast<Index>(i);
    const bool prior = std::isfinite(parameters[i].prior_sd);
    if (solution.at_bound[i] != 0) {
      found[i] = IntervalDoubt::at_bound;
    } else if (known.standing[i] == Standing::unseen) {
      found[i] = IntervalDoubt::not_visible;
    } else if (!prior || record_share[j] > kSeen) {
      if (is_large(parameters[i], solution.x[j], known.std_error[j])) {
        found[i] = IntervalDoubt::large_std_error;
      }
    }
  }
  check_curvature(problem, solution, known, found);
  return found;
}

std::vector<Profile> profiles(const EstimationProblem& question, const EstimationOptions& options,
                              const Problem& problem, const Solution& solution,
                              const Covariance& known, const std::vector<char>& chosen) {
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i] != 0) which.push_back(i);
  }
  std::vector<Profile> found(chosen.size());
  const SimulationWidth width = which.size() == 1 ? wide(options.threads) : SimulationWidth{};
  in_parallel(which.size(), options.threads, [&](std::size_t k) {
    const std::size_t i = which[k];
    const auto j = static_cast<Index>(i);
    ParallelSimulation run(question.model, question.data, question.parameters,
                           options.observer_per_s, width);
    Problem own = problem;
    own.evaluate = run.evaluate();
    own.lanes = run.lanes();
    ProfileOptions profile_options;
    profile_options.minimize.cost_tolerance = 1e-5;
    profile_options.minimize.max_iterations = 15;
    profile_options.minimize.renew_all = false;
    profile_options.minimize.cancel = options.cancel;
    if (known.inflation[j] > 0.0) profile_options.inflation = known.inflation[j];
    if (std::isfinite(known.std_error[j]))
      profile_options.first_step = kInterval * known.std_error[j];
    found[i] = estimator::nonlinear::profile(own, solution, j, profile_options);
  });
  return found;
}

void apply_profile(const estimator::nonlinear::Profile& walked, EstimatedParameter& q) {
  const FreeParameter& p = q.free;
  for (const auto& point : walked.points)
    q.profile.push_back({p.to_physical(point.value), point.rise});
  q.low_found = walked.low_found;
  q.high_found = walked.high_found;
  q.low = p.to_physical(walked.low);
  q.high = p.to_physical(walked.high);
  if (p.scale == ParameterScale::reciprocal) {
    std::reverse(q.profile.begin(), q.profile.end());
    std::swap(q.low, q.high);
    std::swap(q.low_found, q.high_found);
  }
  q.from_profile = !walked.cancelled;
}

}  // namespace estimator::greybox
