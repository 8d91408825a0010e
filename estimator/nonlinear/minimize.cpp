#include "estimator/nonlinear/minimize.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "estimator/nonlinear/search.h"

namespace estimator::nonlinear {
namespace {

constexpr double kLeastDamping = 1e-12;
constexpr int kScanLeast = 6;        // dampings in a scan, at least
constexpr double kScanFactor = 5.0;  // between two of them
constexpr double kAlternates[] = {30.0, 1.0 / 30.0, 1e3};
constexpr std::size_t kMostAlternates = std::size(kAlternates);
constexpr int kSmallInARow = 3;

}  // namespace

bool Search::iterate() {
  linearise();
  const double promised = predicted_decrease(model_, step_for(kLeastDamping));
  const bool hopeless = !(promised > options_.cost_tolerance * cost_);
  if (hopeless || small_ >= kSmallInARow) {
    const std::vector<Eigen::Index> old = stale();
    if (old.empty()) {
      return stop(hopeless ? StopReason::no_further_decrease : StopReason::small_decrease, true);
    }
    small_ = 0;
    renew(old);
    return true;
  }

  const Eigen::VectorXd step = step_for(lambda_);
  const Eigen::VectorXd trial = inside(x_ + step);
  // Columns beside the trial: perturbed points around it, other dampings in the remaining lanes.
  for (int& age : age_) ++age;
  const std::vector<Eigen::Index> order = stale();
  for (int& age : age_) --age;
  const std::vector<Probe> probes = probes_at(problem_, trial, order, options_.central);
  const auto lanes = static_cast<std::size_t>(std::max<Eigen::Index>(1, problem_.lanes));
  const std::size_t needed = probes.size() + 1;
  const std::size_t spare = (needed + lanes - 1) / lanes * lanes - needed;
  const std::size_t alternates =
      (options_.renew_all || needed <= lanes) ? std::min({spare, kMostAlternates, lanes - 1}) : 0;
  const std::size_t speculative = std::min(probes.size(), lanes - 1 - alternates);
  Eigen::MatrixXd points(p_, static_cast<Eigen::Index>(1 + alternates + speculative));
  points.col(0) = trial;
  for (std::size_t k = 0; k < alternates; ++k) {
    points.col(static_cast<Eigen::Index>(k + 1)) =
        inside(x_ + step_for(std::max(kLeastDamping, lambda_ * kAlternates[k])));
  }
  points.rightCols(static_cast<Eigen::Index>(speculative)) =
      points_at(trial, probes, 0, speculative);
  const Eigen::MatrixXd results = groups_.run(points);

  const double trial_cost = cost_of(problem_, trial, results.col(0));
  double best_cost = trial_cost;
  Eigen::Index best = 0;
  for (Eigen::Index k = 1; k <= static_cast<Eigen::Index>(alternates); ++k) {
    const double cost = cost_of(problem_, points.col(k), results.col(k));
    if (cost < best_cost) {
      best_cost = cost;
      best = k;
    }
  }
  if (!(best_cost < cost_)) {
    const std::vector<Eigen::Index> old = stale();
    if (!old.empty()) {  // perhaps only the Jacobian is to blame
      renew(old);
      return true;
    }
    return scan();
  }
  // The trial brings its Jacobian along: another damping must be clearly better.
  if (best > 0 && cost_ - best_cost > 1.25 * (cost_ - trial_cost)) {
    lambda_ = std::max(kLeastDamping, lambda_ * kAlternates[best - 1]);
    const Eigen::VectorXd there = points.col(best);
    if (!options_.renew_all) broyden(there - x_, results.col(best));
    move_to(there, results.col(best), best_cost);
    if (options_.renew_all) renew(stale());
    ++out_.iterations;
    return true;
  }
  const double ratio = (cost_ - trial_cost) / predicted_decrease(model_, step);
  lambda_ = std::max(kLeastDamping,
                     lambda_ * std::max(0.1, 1.0 - std::pow(2.0 * std::min(ratio, 1.0) - 1.0, 3)));
  const bool all_there = speculative == probes.size();
  if (!options_.renew_all && !all_there) broyden(step, results.col(0));
  move_to(trial, results.col(0), trial_cost);
  // Central pairs must not be torn: a column counts when all its probes are there.
  std::size_t whole = speculative;
  while (whole > 0 && whole < probes.size() && probes[whole - 1].column == probes[whole].column) {
    --whole;
  }
  const std::vector<Probe> done(probes.begin(),
                                probes.begin() + static_cast<std::ptrdiff_t>(whole));
  fill_columns(problem_, x_, r_, done,
               results.middleCols(static_cast<Eigen::Index>(1 + alternates),
                                  static_cast<Eigen::Index>(whole)),
               groups_, J_);
  for (const Probe& probe : done) age_[static_cast<std::size_t>(probe.column)] = 0;
  if (options_.renew_all) {
    const std::vector<Eigen::Index> rest = stale();
    if (!rest.empty()) renew(rest);
  }
  ++out_.iterations;
  return true;
}

bool Search::scan() {
  const Eigen::Index count = std::max<Eigen::Index>(kScanLeast, problem_.lanes);
  for (;;) {
    if (options_.cancel && options_.cancel()) return stop(StopReason::cancelled, false);
    Eigen::MatrixXd points(p_, count);
    std::vector<double> lambda(static_cast<std::size_t>(count));
    for (Eigen::Index k = 0; k < count; ++k) {
      lambda_ = std::max(1e-8, lambda_ * kScanFactor);
      lambda[static_cast<std::size_t>(k)] = lambda_;
      points.col(k) = inside(x_ + step_for(lambda_));
    }
    const Eigen::MatrixXd results = groups_.run(points);
    Eigen::Index best = -1;
    double best_cost = cost_;
    for (Eigen::Index k = 0; k < count; ++k) {
      const double cost = cost_of(problem_, points.col(k), results.col(k));
      if (cost < best_cost) {
        best_cost = cost;
        best = k;
      }
    }
    if (best >= 0) {
      lambda_ = lambda[static_cast<std::size_t>(best)];
      const Eigen::VectorXd there = points.col(best);
      if (!options_.renew_all) broyden(there - x_, results.col(best));
      move_to(there, results.col(best), best_cost);
      if (options_.renew_all) renew(stale());
      ++out_.iterations;
      return true;
    }
    if (is_small(points.col(count - 1) - x_) || lambda_ > 1e20) {
      return stop(StopReason::small_step, true);
    }
  }
}

Solution Search::run(const Eigen::VectorXd& start) {
  assert(start.size() == p_ && problem_.sigma > 0.0);
  if (!begin(start)) {
    stop(StopReason::start_not_finite, false);
  } else {
    out_.reason = StopReason::iteration_limit;
    for (int round = 0; round < options_.max_iterations; ++round) {
      if (options_.cancel && options_.cancel()) {
        stop(StopReason::cancelled, false);
        break;
      }
      const bool more = iterate();
      if (options_.progress) {
        options_.progress({out_.iterations, cost_, rms_of(problem_, r_), &x_});
      }
      if (!more) break;
    }
    if (options_.final_jacobian && out_.reason != StopReason::cancelled) {
      const std::vector<Eigen::Index> old = stale();
      if (!old.empty()) renew(old);
    }
  }
  out_.x = x_;
  out_.cost = cost_;
  out_.rms = rms_of(problem_, r_);
  out_.residual = r_;
  out_.jacobian = J_;
  out_.evaluations = groups_.groups();
  out_.points = groups_.points();
  out_.damping = lambda_;
  out_.at_bound.assign(static_cast<std::size_t>(p_), 0);
  for (Eigen::Index j = 0; j < p_; ++j) {
    const Unknown& unknown = problem_.unknowns[static_cast<std::size_t>(j)];
    const auto k = static_cast<std::size_t>(j);
    if (x_[j] >= unknown.upper) out_.at_bound[k] = 1;
    if (x_[j] <= unknown.lower) out_.at_bound[k] = -1;
  }
  return out_;
}

const char* to_string(StopReason stop) {
  switch (stop) {
    case StopReason::no_further_decrease:
      return "no further decrease in sight";
    case StopReason::small_decrease:
      return "the last steps gained next to nothing";
    case StopReason::small_step:
      return "no step lowers the cost";
    case StopReason::iteration_limit:
      return "iteration limit reached";
    case StopReason::cancelled:
      return "cancelled";
    case StopReason::start_not_finite:
      return "the model cannot be evaluated at the start";
  }
  return "";
}

Solution minimize(const Problem& problem, const Eigen::VectorXd& start,
                  const MinimizeOptions& options) {
  return Search(problem, options).run(start);
}

}  // namespace estimator::nonlinear
