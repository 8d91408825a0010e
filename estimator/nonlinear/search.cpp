#include "estimator/nonlinear/search.h"

#include <algorithm>
#include <cmath>

namespace estimator::nonlinear {
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
  const std::vector<Probe> probes = probes_at(problem_, x_, columns, options_.central);
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
  const std::vector<Probe> probes = probes_at(problem_, x_, missing, options_.central);
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

}  // namespace estimator::nonlinear
