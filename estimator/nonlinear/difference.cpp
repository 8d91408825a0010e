#include "estimator/nonlinear/difference.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace estimator::nonlinear {

Eigen::MatrixXd Groups::run(const Eigen::MatrixXd& points) {
  Eigen::MatrixXd out(problem_->residuals, points.cols());
  const Eigen::Index lanes = std::max<Eigen::Index>(1, problem_->lanes);
  for (Eigen::Index first = 0; first < points.cols(); first += lanes) {
    const Eigen::Index count = std::min(lanes, points.cols() - first);
    Eigen::MatrixXd part(problem_->residuals, count);
    problem_->evaluate(points.middleCols(first, count), part);
    assert(part.rows() == problem_->residuals && part.cols() == count);
    if (count == points.cols()) {
      out = std::move(part);
    } else {
      out.middleCols(first, count) = part;
    }
    ++groups_;
    points_ += static_cast<int>(count);
  }
  return out;
}

std::vector<DifferenceStep> probes_at(const Problem& problem, const Eigen::VectorXd& x,
                                      const std::vector<Eigen::Index>& columns, bool central) {
  std::vector<DifferenceStep> out;
  for (const Eigen::Index j : columns) {
    const Unknown& unknown = problem.unknowns[static_cast<std::size_t>(j)];
    if (unknown.is_held()) continue;
    double h = std::max(unknown.step, unknown.relative_step * std::abs(x[j]));
    if (!(h > 0.0)) h = 1e-8;
    const double above = unknown.upper - x[j];
    const double below = x[j] - unknown.lower;
    const double room = 1.01 * h;  // rounding must not carry a point over the bound
    if (central && above >= room && below >= room) {
      out.push_back({j, h});
      out.push_back({j, -h});
    } else if (above >= room) {
      out.push_back({j, h});
    } else if (below >= room) {
      out.push_back({j, -h});
    } else {
      out.push_back({j, above > below ? 0.5 * above : -0.5 * below});
    }
  }
  return out;
}

Eigen::MatrixXd points_at(const Eigen::VectorXd& x, const std::vector<DifferenceStep>& probes,
                          std::size_t first, std::size_t count) {
  Eigen::MatrixXd out = x.replicate(1, static_cast<Eigen::Index>(count));
  for (std::size_t k = 0; k < count; ++k) {
    out(probes[first + k].column, static_cast<Eigen::Index>(k)) += probes[first + k].offset;
  }
  return out;
}

bool is_finite(const Problem& problem, const Eigen::Ref<const Eigen::VectorXd>& residual) {
  if (problem.weights.size() == 0) return residual.allFinite();
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    if (problem.weights[i] > 0.0 && !std::isfinite(residual[i])) return false;
  }
  return true;
}

void fill_columns(const Problem& problem, const Eigen::VectorXd& x, const Eigen::VectorXd& residual,
                  const std::vector<DifferenceStep>& probes, const Eigen::MatrixXd& results,
                  Groups& groups, Eigen::MatrixXd& jacobian) {
  // The offset that x really got, after rounding.
  const auto moved = [&](const DifferenceStep& probe) {
    volatile const double there = x[probe.column] + probe.offset;
    return there - x[probe.column];
  };
  std::vector<DifferenceStep> again;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    const auto column = results.col(static_cast<Eigen::Index>(k));
    const Eigen::Index j = probes[k].column;
    const bool pair = k + 1 < probes.size() && probes[k + 1].column == j;
    if (pair) {
      const auto other = results.col(static_cast<Eigen::Index>(k + 1));
      const double span = moved(probes[k]) - moved(probes[k + 1]);
      jacobian.col(j) = (column - other) / span;
      ++k;
    } else {
      jacobian.col(j) = (column - residual) / moved(probes[k]);
    }
    if (is_finite(problem, jacobian.col(j))) continue;
    jacobian.col(j).setZero();
    const Unknown& unknown = problem.unknowns[static_cast<std::size_t>(j)];
    const double turned = -0.1 * probes[k].offset;
    const double there = x[j] + turned;
    again.push_back(
        {j, there > unknown.lower && there < unknown.upper ? turned : 0.1 * probes[k].offset});
  }
  if (again.empty()) return;
  const Eigen::MatrixXd second = groups.run(points_at(x, again, 0, again.size()));
  for (std::size_t k = 0; k < again.size(); ++k) {
    const Eigen::Index j = again[k].column;
    jacobian.col(j) = (second.col(static_cast<Eigen::Index>(k)) - residual) / moved(again[k]);
    if (!is_finite(problem, jacobian.col(j))) jacobian.col(j).setZero();
  }
}

}  // namespace estimator::nonlinear
