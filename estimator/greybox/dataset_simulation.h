// Simulation of a model over all records of a data set: one ObserverSimulation per record,
// residuals concatenated in the order of the records.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/greybox/fit_dataset.h"
#include "estimator/greybox/observer_simulation.h"

namespace estimator::greybox {

class DatasetSimulation {
 public:
  /// The data set must outlive this object.
  DatasetSimulation(const plant_sim::ModelFile& model, const FitDataset& data,
                    const std::vector<FreeParameter>& parameters,
                    double observer_per_s = kObserver_per_s);

  /// Residuals in m, data.size() x points.cols(); at most ObserverSimulation::kLanes columns.
  void residuals(const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals_m);
  /// Adds `added_V` to the command and `added_N` to the load force of each lane; both are empty or
  /// have the size of residuals_m.
  void residuals(const Eigen::MatrixXd& points, const Eigen::MatrixXd& added_V,
                 const Eigen::MatrixXd& added_N, Eigen::MatrixXd& residuals_m);

 private:
  std::vector<ObserverSimulation> runs_;
  std::vector<Eigen::Index> sizes_;
};

}  // namespace estimator::greybox
