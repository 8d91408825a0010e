#include "estimator/greybox/selection/innovation_jacobian.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "estimator/greybox/disturbance/kalman_gains.h"
#include "estimator/greybox/fit.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kStep = kLogarithmStep;
/// Parameters of one simulation: a point to either side of each.
constexpr Index kAtOnce = ObserverSimulation::kLanes / 2;

/// Predictor of the stage at another theta, its innovations scaled as the stage's own.
InnovationGains gains_at(const InnovationStage& stage, std::size_t r, const VectorXd& theta) {
  const FitDataset& data = stage.context.problem.data;
  const Dataset& record = data.records[r];
  const disturbance::Linearisation model =
      disturbance::linearise(stage.context.problem.model, record, stage.model.fitted.parameters,
                             theta, stage.noise.force_place);
  InnovationGains gains =
      disturbance::kalman_gains(model, record, stage.noise.noise, data.noise_floor_m).gains;
  gains.scale = record.innovations->scale;
  gains.line_m = record.innovations->line_m;
  return gains;
}

}  // namespace

MatrixXd innovation_jacobian(const InnovationStage& stage, unsigned threads) {
  const FitDataset& data = stage.context.problem.data;
  const FitSummary& fitted = stage.model.fitted;
  std::vector<Index> open;
  for (Index i = 0; i < fitted.theta.size(); ++i) {
    if (fitted.at_bound[static_cast<std::size_t>(i)] == 0) open.push_back(i);
  }
  const auto count = static_cast<Index>(open.size());
  const Index batches = (count + kAtOnce - 1) / kAtOnce;
  MatrixXd jacobian = MatrixXd::Zero(data.size(), fitted.theta.size());
  for (std::size_t r = 0; r < data.records.size(); ++r) {
    const Dataset& record = data.records[r];
    const MatrixXd& lines = record.innovations->lines;
    in_parallel(static_cast<std::size_t>(batches), threads, [&](std::size_t batch) {
      const Index from = static_cast<Index>(batch) * kAtOnce;
      const Index here = std::min(kAtOnce, count - from);
      MatrixXd points = fitted.theta.replicate(1, 2 * here);
      std::vector<InnovationGains> gains;
      for (Index i = 0; i < 2 * here; ++i) {
        const Index j = open[static_cast<std::size_t>(from + i / 2)];
        const FreeParameter& p = fitted.parameters[static_cast<std::size_t>(j)];
        const double step = kStep * std::max(1.0, std::abs(fitted.theta[j]));
        points(j, i) = i % 2 == 0 ? std::min(p.upper, fitted.theta[j] + step)
                                  : std::max(p.lower, fitted.theta[j] - step);
        gains.push_back(gains_at(stage, r, points.col(i)));
      }
      ObserverSimulation run(stage.context.problem.model, record, fitted.parameters);
      MatrixXd innovations;
      run.innovations(points, gains, innovations);
      if (lines.cols() > 0) innovations -= lines * (lines.transpose() * innovations).eval();
      for (Index i = 0; i < here; ++i) {
        const Index j = open[static_cast<std::size_t>(from + i)];
        const double apart = points(j, 2 * i) - points(j, 2 * i + 1);
        jacobian.col(j).segment(static_cast<Index>(data.starts[r]), innovations.rows()) =
            (innovations.col(2 * i) - innovations.col(2 * i + 1)) / apart;
      }
    });
  }
  return jacobian;
}

}  // namespace estimator::greybox::selection
