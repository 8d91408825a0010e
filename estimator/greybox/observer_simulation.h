// A model driven by the measured command, up to eight parameter sets side by side, over all
// segments of a record.
//
//   yh(k) = reading(k),   then  yh += l Ts (y(k) - yh(k)),   then u(k) held for Ts
//
// y yh measured and modelled position; l the observer's gain, 1/s. l = 0 is the free run from
// each segment's start; a small l takes away the drift of an integrating plant and leaves what is
// faster than 1/l as it is. A segment that begins in the midst of a motion is led at
// kLeading_per_s while it settles.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "estimator/greybox/dataset.h"
#include "estimator/greybox/free_parameter.h"
#include "plant_sim/ensemble.h"

namespace estimator::greybox {

/// Found to work for the thesis's actuator: fast enough against drift, slow enough for slow
/// effects.
inline constexpr double kObserver_per_s = 2.0;

class ObserverSimulation {
 public:
  static constexpr Eigen::Index kLanes = plant_sim::Ensemble::kLanes;

  /// Searched parameters that the model knows; the others stay as in the model file. The record
  /// must outlive this object. Throws config::schema::Error for a model that cannot be built.
  ObserverSimulation(const plant_sim::ModelFile& model, const Dataset& record,
                     std::vector<FreeParameter> parameters,
                     double observer_per_s = kObserver_per_s);

  /// Measured less modelled position, size() x points.cols(), for each column of search values
  /// (searched().size() rows, at most kLanes columns). Samples before a segment has settled give 0.
  void residuals(const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals_m);

  /// The same, with what is added to command and load in each lane (size() x points.cols(), or
  /// empty): for finding out where a residual enters.
  void residuals(const Eigen::MatrixXd& points, const Eigen::MatrixXd& added_V,
                 const Eigen::MatrixXd& added_N, Eigen::MatrixXd& residuals_m);

  /// Model pressures of every sample in each lane, size() x kLanes.
  struct Chambers {
    Eigen::MatrixXd in_Pa;
    Eigen::MatrixXd out_Pa;
  };
  /// The same as the first, with the model's chamber pressures; of the observer they feel nothing
  /// but that the rod is elsewhere.
  void residuals(const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals_m, Chambers& chambers);

  [[nodiscard]] const std::vector<FreeParameter>& parameters() const { return parameters_; }
  [[nodiscard]] std::size_t size() const { return record_->size(); }
  /// The model's speed of lane 0 in the latest run, one for each sample.
  [[nodiscard]] const std::vector<double>& speed_mps() const { return speed_mps_; }

 private:
  void run(const Eigen::MatrixXd& points, const Eigen::MatrixXd& added_V,
           const Eigen::MatrixXd& added_N, Eigen::MatrixXd& residuals_m, Chambers* chambers);

  const Dataset* record_;
  std::vector<FreeParameter> parameters_;
  double observer_per_s_;
  std::unique_ptr<plant_sim::Ensemble> ensemble_;
  std::vector<std::size_t> index_;
  std::vector<double> speed_mps_;
};

/// Integration step for a record: the model's own, made to divide the record's sample time.
[[nodiscard]] double step_for(const plant_sim::ModelFile& model, double sample_time_s);

}  // namespace estimator::greybox
