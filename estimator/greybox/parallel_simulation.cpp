#include "estimator/greybox/parallel_simulation.h"

#include <algorithm>

#include "estimator/parallel.h"

namespace estimator::greybox {

ParallelSimulation::ParallelSimulation(const plant_sim::ModelFile& model, const FitDataset& data,
                                       const std::vector<FreeParameter>& parameters,
                                       double observer_per_s, SimulationWidth width)
    : threads_(width.threads) {
  for (unsigned i = 0; i < std::max(1U, width.groups); ++i) {
    runs_.emplace_back(model, data, parameters, observer_per_s);
  }
}

Eigen::Index ParallelSimulation::lanes() const {
  return ObserverSimulation::kLanes * static_cast<Eigen::Index>(runs_.size());
}

void ParallelSimulation::residuals(const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals_m) {
  if (points.cols() <= ObserverSimulation::kLanes) {
    runs_.front().residuals(points, residuals_m);
    return;
  }
  const auto groups =
      static_cast<std::size_t>((points.cols() - 1) / ObserverSimulation::kLanes + 1);
  std::vector<Eigen::MatrixXd> parts(groups);
  in_parallel(groups, threads_, [&](std::size_t g) {
    const Eigen::Index first = static_cast<Eigen::Index>(g) * ObserverSimulation::kLanes;
    const Eigen::Index count = std::min(ObserverSimulation::kLanes, points.cols() - first);
    runs_[g].residuals(points.middleCols(first, count), parts[g]);
  });
  residuals_m.resize(parts.front().rows(), points.cols());
  Eigen::Index at = 0;
  for (const Eigen::MatrixXd& part : parts) {
    residuals_m.middleCols(at, part.cols()) = part;
    at += part.cols();
  }
}

estimator::nonlinear::Evaluate ParallelSimulation::evaluate() {
  return [this](const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals_m) {
    residuals(points, residuals_m);
  };
}

}  // namespace estimator::greybox
