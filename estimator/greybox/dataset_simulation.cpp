#include "estimator/greybox/dataset_simulation.h"

namespace estimator::greybox {

DatasetSimulation::DatasetSimulation(const plant_sim::ModelFile& model, const FitDataset& data,
                                     const std::vector<FreeParameter>& parameters,
                                     double observer_per_s) {
  runs_.reserve(data.records.size());
  for (const Dataset& record : data.records) {
    runs_.emplace_back(model, record, parameters, observer_per_s);
    sizes_.push_back(static_cast<Eigen::Index>(record.size()));
  }
}

void DatasetSimulation::residuals(const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals_m) {
  residuals(points, {}, {}, residuals_m);
}

void DatasetSimulation::residuals(const Eigen::MatrixXd& points, const Eigen::MatrixXd& added_V,
                                  const Eigen::MatrixXd& added_N, Eigen::MatrixXd& residuals_m) {
  if (runs_.size() == 1) {
    runs_.front().residuals(points, added_V, added_N, residuals_m);
    return;
  }
  Eigen::Index total = 0;
  for (const Eigen::Index size : sizes_) total += size;
  residuals_m.resize(total, points.cols());
  Eigen::MatrixXd one_m;
  Eigen::Index at = 0;
  const auto rows = [&](const Eigen::MatrixXd& added, Eigen::Index size) -> Eigen::MatrixXd {
    if (added.size() == 0) return {};
    return added.middleRows(at, size);
  };
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    runs_[i].residuals(points, rows(added_V, sizes_[i]), rows(added_N, sizes_[i]), one_m);
    residuals_m.middleRows(at, sizes_[i]) = one_m;
    at += sizes_[i];
  }
}

}  // namespace estimator::greybox
