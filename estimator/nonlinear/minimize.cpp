#include "estimator/nonlinear/minimize.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "estimator/nonlinear/difference.h"
#include "estimator/nonlinear/linear_model.h"

namespace estimator::nonlinear {

// The state of one minimisation and its steps; see minimize.h for the method.

/// One search: the point, its linearisation, the damping.
class Search {
 public:
  Search(const Problem& problem, const MinimizeOptions& options)
      : problem_(problem), options_(options), groups_(problem), p_(problem.size()) {}

  Solution run(const Eigen::VectorXd& start);

 private:
  bool begin(const Eigen::VectorXd& start);
  /// One accepted step, or the reason why there is none.
  bool iterate();
  /// Moves to a point whose Jacobian is not known.
  bool accept(const Eigen::VectorXd& there, const Eigen::VectorXd& residual, double cost);
  bool scan();
  void linearise();
  void renew(const std::vector<Eigen::Index>& columns);
  void broyden(const Eigen::VectorXd& step, const Eigen::VectorXd& residual);
  void move_to(const Eigen::VectorXd& x, const Eigen::VectorXd& residual, double cost);
  [[nodiscard]] Eigen::VectorXd step_for(double lambda) const;
  [[nodiscard]] Eigen::VectorXd inside(Eigen::VectorXd x) const;
  [[nodiscard]] std::vector<Eigen::Index> stale() const;
  [[nodiscard]] bool is_small(const Eigen::VectorXd& step) const;
  bool stop(StopReason reason, bool converged) {
    out_.reason = reason;
    out_.converged = converged;
    return false;
  }

  const Problem& problem_;
  const MinimizeOptions& options_;
  Groups groups_;
  Eigen::Index p_;
  Eigen::VectorXd x_;
  Eigen::VectorXd r_;
  Eigen::MatrixXd J_;
  std::vector<int> age_;  // iterations since a column was evaluated; 0 = at x
  double cost_ = 0.0;
  LinearModel model_;
  Eigen::VectorXd D_;
  Eigen::VectorXd low_;
  Eigen::VectorXd high_;
  double lambda_ = 0.0;
  int small_ = 0;
  Solution out_;
};

namespace {

constexpr double kMemory = 0.5;  // weight of the previous iteration's largest column norms

}  // namespace

std::vector<Eigen::Index> Search::stale() const {
  std::vector<Eigen::Index> out;
  for (Eigen::Index j = 0; j < p_; ++j) {
    if (age_[static_cast<std::size_t>(j)] > 0 &&
        !problem_.unknowns[static_cast<std::size_t>(j)].is_held()) {
      out.push_back(j);
    }
  }
  std::stable_sort(out.begin(), out.end(), [&](Eigen::Index a, Eigen::Index b) {
    return age_[static_cast<std::size_t>(a)] > age_[static_cast<std::size_t>(b)];
  });
  return out;
}

Eigen::VectorXd Search::inside(Eigen::VectorXd x) const {
  for (Eigen::Index j = 0; j < p_; ++j) {
    const Unknown& unknown = problem_.unknowns[static_cast<std::size_t>(j)];
    x[j] = std::max(unknown.lower, std::min(unknown.upper, x[j]));
  }
  return x;
}

void Search::renew(const std::vector<Eigen::Index>& columns) {
  const std::vector<DifferenceStep> probes = probes_at(problem_, x_, columns, options_.central);
  const Eigen::MatrixXd results = groups_.run(points_at(x_, probes, 0, probes.size()));
  fill_columns(problem_, x_, r_, probes, results, groups_, J_);
  for (const Eigen::Index j : columns) age_[static_cast<std::size_t>(j)] = 0;
}

bool Search::begin(const Eigen::VectorXd& start) {
  x_ = inside(start);
  J_ = Eigen::MatrixXd::Zero(problem_.residuals, p_);
  D_ = Eigen::VectorXd::Zero(p_);
  age_.assign(static_cast<std::size_t>(p_), 1);
  lambda_ = options_.first_damping;
  const bool at_start = x_ == start;
  const Eigen::MatrixXd& known = options_.start_jacobian;
  for (Eigen::Index j = 0; at_start && known.rows() == problem_.residuals && j < p_; ++j) {
    if (std::isnan(known(0, j))) continue;
    J_.col(j) = known.col(j);
    age_[static_cast<std::size_t>(j)] = 0;
  }
  const std::vector<Eigen::Index> missing = stale();
  if (at_start && options_.start_residual.size() == problem_.residuals) {
    r_ = options_.start_residual;
    cost_ = cost_of(problem_, x_, r_);
    if (!std::isfinite(cost_)) return false;
    if (!missing.empty()) renew(missing);
    return true;
  }
  const std::vector<DifferenceStep> probes = probes_at(problem_, x_, missing, options_.central);
  const auto count = static_cast<Eigen::Index>(probes.size());
  Eigen::MatrixXd points(p_, count + 1);
  points.col(0) = x_;
  points.rightCols(count) = points_at(x_, probes, 0, probes.size());
  const Eigen::MatrixXd results = groups_.run(points);
  r_ = results.col(0);
  cost_ = cost_of(problem_, x_, r_);
  if (!std::isfinite(cost_)) return false;
  fill_columns(problem_, x_, r_, probes, results.rightCols(count), groups_, J_);
  std::fill(age_.begin(), age_.end(), 0);
  return true;
}

void Search::linearise() {
  model_ = compress(problem_, x_, r_, J_);
  low_.resize(p_);
  high_.resize(p_);
  for (Eigen::Index j = 0; j < p_; ++j) {
    const Unknown& unknown = problem_.unknowns[static_cast<std::size_t>(j)];
    low_[j] = std::max(unknown.lower - x_[j], -unknown.max_step);
    high_[j] = std::min(unknown.upper - x_[j], unknown.max_step);
    if (unknown.is_held()) low_[j] = high_[j] = 0.0;
    D_[j] = std::max(kMemory * D_[j], model_.R.col(j).norm());
    if (!(D_[j] > 0.0)) D_[j] = 1e-12;
  }
}

Eigen::VectorXd Search::step_for(double lambda) const {
  return box_step(model_, D_, lambda, low_, high_);
}

bool Search::is_small(const Eigen::VectorXd& step) const {
  for (Eigen::Index j = 0; j < p_; ++j) {
    const double floor = problem_.unknowns[static_cast<std::size_t>(j)].step;
    if (std::abs(step[j]) > options_.step_tolerance * std::max(std::abs(x_[j]), floor)) {
      return false;
    }
  }
  return true;
}

void Search::broyden(const Eigen::VectorXd& step, const Eigen::VectorXd& residual) {
  const Eigen::VectorXd scaled = D_.cwiseProduct(step);
  const double square = scaled.squaredNorm();
  if (!(square > 0.0)) return;
  const Eigen::VectorXd error = (residual - r_ - J_ * step) / square;
  if (!is_finite(problem_, error)) return;
  for (Eigen::Index j = 0; j < p_; ++j) J_.col(j) += error * (scaled[j] * D_[j]);
}

void Search::move_to(const Eigen::VectorXd& x, const Eigen::VectorXd& residual, double cost) {
  small_ = cost_ - cost <= options_.cost_tolerance * cost_ ? small_ + 1 : 0;
  x_ = x;
  r_ = residual;
  cost_ = cost;
  for (int& age : age_) ++age;
}

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
    if (old.empty())
      return stop(hopeless ? StopReason::no_further_decrease : StopReason::small_decrease, true);
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
  const std::vector<DifferenceStep> probes = probes_at(problem_, trial, order, options_.central);
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
    return accept(points.col(best), results.col(best), best_cost);
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
  const std::vector<DifferenceStep> done(probes.begin(),
                                         probes.begin() + static_cast<std::ptrdiff_t>(whole));
  fill_columns(problem_, x_, r_, done,
               results.middleCols(static_cast<Eigen::Index>(1 + alternates),
                                  static_cast<Eigen::Index>(whole)),
               groups_, J_);
  for (const DifferenceStep& probe : done) age_[static_cast<std::size_t>(probe.column)] = 0;
  if (options_.renew_all) {
    const std::vector<Eigen::Index> rest = stale();
    if (!rest.empty()) renew(rest);
  }
  ++out_.iterations;
  return true;
}

bool Search::accept(const Eigen::VectorXd& there, const Eigen::VectorXd& residual, double cost) {
  if (!options_.renew_all) broyden(there - x_, residual);
  move_to(there, residual, cost);
  if (options_.renew_all) renew(stale());
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
      return accept(points.col(best), results.col(best), best_cost);
    }
    if (is_small(points.col(count - 1) - x_) || lambda_ > 1e20)
      return stop(StopReason::small_step, true);
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

Solution minimize(const Problem& problem, const Eigen::VectorXd& start,
                  const MinimizeOptions& options) {
  return Search(problem, options).run(start);
}

}  // namespace estimator::nonlinear
