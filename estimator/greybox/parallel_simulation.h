// Simulation of more than eight parameter sets: one DatasetSimulation on each of several threads.
#pragma once

#include <vector>

#include "estimator/greybox/dataset_simulation.h"
#include "estimator/nonlinear/problem.h"

namespace estimator::greybox {

class ParallelSimulation {
 public:
  /// `threads` includes the calling thread; at least 1.
  ParallelSimulation(const plant_sim::ModelFile& model, const FitDataset& data,
                     const std::vector<FreeParameter>& parameters, double observer_per_s,
                     unsigned threads);

  [[nodiscard]] Eigen::Index lanes() const;
  /// Residuals in m, data.size() x points.cols(); at most lanes() columns.
  void residuals(const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals_m);
  /// For Problem::evaluate; refers to this object.
  [[nodiscard]] estimator::nonlinear::Evaluate evaluate();

 private:
  std::vector<DatasetSimulation> runs_;
};

}  // namespace estimator::greybox
