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
/// Of the rise that a parabola would have.
constexpr double kBent = 0.4;
constexpr double kSeen = 0.5;

std::string large(const SearchParameter& p, double x, double std_error) {
  if (p.scale == Scale::logarithmic) {
    return std_error > kLargeLogarithm ? "large standard error" : "";
  }
  return std_error > kLargeShare * std::abs(x) ? "large standard error" : "";
}

/// Marks those whose cost, at the ends of their intervals, is not that of the linear model.
void look_for_bends(const Problem& problem, const Solution& solution, const Covariance& known,
                    std::vector<std::string>& found) {
  const Index n = problem.size();
  const auto model =
      estimator::nonlinear::compress(problem, solution.x, solution.residual, solution.jacobian);
  struct End {
    Index j;
    VectorXd step;
  };
  std::vector<End> ends;
  for (Index j = 0; j < n; ++j) {
    if (known.standing[static_cast<std::size_t>(j)] != Standing::kEstimated) continue;
    const double variance = known.matrix(j, j);
    if (!found[static_cast<std::size_t>(j)].empty() || !(variance > 0.0)) continue;
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
    // An interval that is cut at a bound rises little: its profile says so too.
    if (!(std::abs(rise - expected) < kBent * std::max(expected, 1.0))) {
      found[static_cast<std::size_t>(ends[i].j)] = "the likelihood is not quadratic";
    }
  }
}

}  // namespace

std::vector<std::string> doubts(const Problem& problem, const Solution& solution,
                                const Covariance& known,
                                const std::vector<SearchParameter>& searched,
                                const VectorXd& record_share) {
  std::vector<std::string> found(searched.size());
  for (std::size_t i = 0; i < searched.size(); ++i) {
    const auto j = static_cast<Index>(i);
    const bool prior = std::isfinite(searched[i].prior_sd);
    if (solution.at_bound[i] != 0) {
      found[i] = "at its bound";
    } else if (known.standing[i] == Standing::kUnseen) {
      found[i] = "not visible";
    } else if (!prior || record_share[j] > kSeen) {
      found[i] = large(searched[i], solution.x[j], known.std_error[j]);
    }
  }
  look_for_bends(problem, solution, known, found);
  return found;
}

std::vector<Profile> profiles(const Task& task, const Problem& problem, const Solution& solution,
                              const Covariance& known, const std::vector<char>& chosen) {
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i] != 0) which.push_back(i);
  }
  std::vector<Profile> found(chosen.size());
  const auto threads = std::max(
      1U, std::min(task.threads, static_cast<unsigned>(std::max<std::size_t>(1, which.size()))));
  in_parallel(which.size(), threads, [&](std::size_t k) {
    const std::size_t i = which[k];
    const auto j = static_cast<Index>(i);
    WideRun run(task.model, task.evidence, task.searched, task.observer_per_s,
                task.threads / threads);
    Problem own = problem;
    own.evaluate = run.evaluate();
    own.lanes = run.lanes();
    ProfileOptions options;
    options.minimize.cost_tolerance = 1e-5;
    options.minimize.max_iterations = 15;
    options.minimize.renew_all = false;
    options.minimize.cancel = task.cancel;
    if (known.inflation[j] > 0.0) options.inflation = known.inflation[j];
    if (std::isfinite(known.std_error[j])) options.first_step = kInterval * known.std_error[j];
    found[i] = estimator::nonlinear::profile(own, solution, j, options);
  });
  return found;
}

void keep_profile(const estimator::nonlinear::Profile& walked, Parameter& q) {
  const SearchParameter& p = q.search;
  for (const auto& point : walked.points) q.profile.push_back({p.value(point.value), point.rise});
  q.low_found = walked.low_found;
  q.high_found = walked.high_found;
  q.low = p.value(walked.low);
  q.high = p.value(walked.high);
  if (p.scale == Scale::reciprocal) {
    std::reverse(q.profile.begin(), q.profile.end());
    std::swap(q.low, q.high);
    std::swap(q.low_found, q.high_found);
  }
  q.from_profile = !walked.cancelled;
}

}  // namespace estimator::greybox
