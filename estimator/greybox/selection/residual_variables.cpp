#include "estimator/greybox/selection/residual_variables.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/greybox/kinematics.h"
#include "estimator/greybox/observer_simulation.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Share of the samples at either end of a variable's range without knots of their own.
constexpr double kTail = 0.005;

struct MotionSeries {
  VectorXd command_V, position_m, speed_mps, acceleration_mps2, time_s;
};

/// Central differences within a segment.
void differentiate(const Dataset& record, Index at, const VectorXd& speed_mps,
                   VectorXd& acceleration_mps2) {
  for (const SampleRange& span : segments(record)) {
    for (std::size_t k = span.begin; k < span.end; ++k) {
      const std::size_t before = std::max(k, span.begin + 1) - 1;
      const std::size_t after = std::min(k + 1, span.end - 1);
      const double rise_mps =
          speed_mps[at + static_cast<Index>(after)] - speed_mps[at + static_cast<Index>(before)];
      acceleration_mps2[at + static_cast<Index>(k)] =
          rise_mps /
          (record.sample_time_s * static_cast<double>(std::max<std::size_t>(1, after - before)));
    }
  }
}

MotionSeries series(const SearchContext& context, const ModelStage& stage) {
  const Index size = context.problem.data.size();
  MotionSeries s{VectorXd(size), VectorXd(size), VectorXd(size), VectorXd(size), VectorXd(size)};
  MatrixXd ignored;
  Index at = 0;
  for (const Dataset& record : context.problem.data.records) {
    ObserverSimulation run(context.problem.model, record, stage.fitted.parameters);
    run.residuals(stage.fitted.theta, ignored);
    for (std::size_t k = 0; k < record.size(); ++k) {
      const Index row = at + static_cast<Index>(k);
      s.command_V[row] = record.u_V[k];
      s.position_m[row] = record.y_m[k] - stage.fitted.residual_m[row];
      s.speed_mps[row] = run.speed_mps()[k];
      s.time_s[row] = record.t_s[k] - record.t_s.front();
    }
    differentiate(record, at, s.speed_mps, s.acceleration_mps2);
    at += static_cast<Index>(record.size());
  }
  return s;
}

/// Ascending and distinct; empty where the values do not vary.
std::vector<double> knots_of(const VectorXd& values, const VectorXd& counts) {
  std::vector<double> sorted;
  for (Index k = 0; k < values.size(); ++k) {
    if (counts[k] != 0.0 && std::isfinite(values[k])) sorted.push_back(values[k]);
  }
  if (sorted.size() < 2) return {};
  std::sort(sorted.begin(), sorted.end());
  const auto quantile = [&](double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  };
  const double low = quantile(kTail);
  const double high = quantile(1.0 - kTail);
  if (!(high > low)) return {};
  std::vector<double> knots;
  for (int i = 0; i < kKnots; ++i) {
    const double share = static_cast<double>(i) / (kKnots - 1);
    const double even = low + (high - low) * share;
    knots.push_back(0.5 * (even + quantile(kTail + (1.0 - 2.0 * kTail) * share)));
  }
  return knots;
}

MatrixXd directions(const VectorXd& speed_mps) {
  MatrixXd pieces(speed_mps.size(), 2);
  pieces.col(0) = (speed_mps.array() > 0.0).cast<double>();
  pieces.col(1) = 1.0 - pieces.col(0).array();
  return pieces;
}

}  // namespace

MatrixXd pieces_of(const VectorXd& values, const VectorXd& counts) {
  const std::vector<double> knots = knots_of(values, counts);
  MatrixXd pieces = MatrixXd::Zero(values.size(), static_cast<Index>(knots.size()));
  if (knots.empty()) return pieces;
  for (Index k = 0; k < values.size(); ++k) {
    const double x = std::clamp(values[k], knots.front(), knots.back());
    const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, x);
    const Index right = above - knots.begin();
    const double share = (x - *(above - 1)) / (*above - *(above - 1));
    pieces(k, right - 1) = 1.0 - share;
    pieces(k, right) = share;
  }
  return pieces;
}

ResidualVariables variables(const SearchContext& context, const ModelStage& stage) {
  const VectorXd& counts = context.problem.data.all_mask;
  const MotionSeries s = series(context, stage);
  ResidualVariables result;
  const auto add = [&](const char* name, MatrixXd pieces) {
    if (pieces.cols() > 0) result.all.push_back({name, std::move(pieces), {}});
  };
  const auto add_size = [&](const char* name, const VectorXd& values) {
    MatrixXd pieces = pieces_of(values.cwiseAbs(), counts);
    if (pieces.cols() == 0) return;
    MatrixXd turned = values.cwiseSign().asDiagonal() * pieces;
    result.all.push_back({name, std::move(pieces), std::move(turned)});
  };
  // about equal entries: the earlier is named first
  add("direction", directions(s.speed_mps));
  add_size("speed", s.speed_mps);
  add("v", pieces_of(s.speed_mps, counts));
  add_size("u", s.command_V);
  add("u", pieces_of(s.command_V, counts));
  add("y", pieces_of(s.position_m, counts));
  add("acceleration", pieces_of(s.acceleration_mps2, counts));
  add("time", pieces_of(s.time_s, counts));
  result.command_V = s.command_V;
  result.speed_mps = s.speed_mps;
  result.position_m = s.position_m.array() - s.position_m.dot(counts) / counts.sum();
  return result;
}

}  // namespace estimator::greybox::selection
