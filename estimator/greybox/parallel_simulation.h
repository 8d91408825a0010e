// Simulation of more than eight parameter sets: one DatasetSimulation on each of several threads.
#pragma once

#include <vector>

#include "estimator/greybox/dataset_simulation.h"
#include "estimator/nonlinear/problem.h"

namespace estimator::greybox {

/// Groups of eight parameter sets that one evaluation takes, and the threads that share them. A
/// search tries as many points at once as there are lanes: the number of groups is part of its
/// result and never follows from the number of threads.
struct SimulationWidth {
  unsigned groups = 1;
  unsigned threads = 1;  ///< the caller's included
};
[[nodiscard]] constexpr SimulationWidth wide(unsigned threads) { return {2, threads}; }

class ParallelSimulation {
 public:
  ParallelSimulation(const plant_sim::ModelFile& model, const FitDataset& data,
                     const std::vector<FreeParameter>& parameters, double observer_per_s,
                     SimulationWidth width);

  [[nodiscard]] Eigen::Index lanes() const;
  /// Residuals in m, data.size() x points.cols(); at most lanes() columns.
  void residuals(const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals_m);
  /// For Problem::evaluate; refers to this object.
  [[nodiscard]] estimator::nonlinear::Evaluate evaluate();

 private:
  std::vector<DatasetSimulation> runs_;
  unsigned threads_;
};

}  // namespace estimator::greybox
