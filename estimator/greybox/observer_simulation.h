// Simulation of a model driven by the measured command over all segments of a record, up to eight
// parameter sets side by side.
//
//   yh(k) = reading(k),   then  yh += l Ts (y(k) - yh(k)),   then u(k) held for Ts
//
// y, yh measured and modelled position; l the observer gain, 1/s. l = 0 is the free run from each
// segment's start; a small l removes the drift of an integrating plant and leaves components faster
// than 1/l unchanged. A segment that begins during a motion uses the gain kInitialisation_per_s
// while it settles.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "estimator/greybox/dataset.h"
#include "estimator/greybox/free_parameter.h"
#include "estimator/greybox/innovation_gains.h"
#include "plant_sim/ensemble.h"
#include "plant_sim/ensemble_schedule.h"

namespace estimator::greybox {

/// Default observer gain: fast enough against drift, slow enough for slow effects; established for
/// the thesis's actuator.
inline constexpr double kObserver_per_s = 2.0;

class ObserverSimulation {
 public:
  static constexpr Eigen::Index kLanes = plant_sim::Ensemble::kLanes;

  /// `parameters`: free parameters known to the model; the others stay as in the model file. The
  /// record must outlive this object. Throws config::schema::ConfigError for a model that cannot be
  /// built.
  ObserverSimulation(const plant_sim::ModelFile& model, const Dataset& record,
                     std::vector<FreeParameter> parameters,
                     double observer_per_s = kObserver_per_s);

  /// Measured less modelled position [m], size() x points.cols(), one column per column of theta
  /// (parameters().size() rows, at most kLanes columns). Samples of an unsettled segment give 0.
  void residuals(const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals_m);

  /// The same with additions to command and load in each lane (size() x points.cols(), or empty):
  /// locates the site at which a residual enters.
  void residuals(const Eigen::MatrixXd& points, const Eigen::MatrixXd& added_V,
                 const Eigen::MatrixXd& added_N, Eigen::MatrixXd& residuals_m);

  /// Modelled pressures of every sample in each lane, size() x kLanes.
  struct Chambers {
    Eigen::MatrixXd in_Pa;
    Eigen::MatrixXd out_Pa;
  };
  /// As the first, with the modelled chamber pressures; the observer corrects the position alone.
  void residuals(const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals_m, Chambers& chambers);

  [[nodiscard]] const std::vector<FreeParameter>& parameters() const { return parameters_; }
  [[nodiscard]] std::size_t size() const { return record_->size(); }
  [[nodiscard]] PlantStart plant_start() const;
  /// Scaled innovations with gains of their own in each lane, size() x points.cols(); no lines are
  /// projected out. Every element of `gains` has the states of the first.
  void innovations(const Eigen::MatrixXd& points, std::span<const InnovationGains> gains,
                   Eigen::MatrixXd& residuals_m);

  /// Modelled speed of lane 0 in the latest run, one per sample.
  [[nodiscard]] const std::vector<double>& speed_mps() const { return speed_mps_; }
  /// Lane 0 in the latest run: rod and reading as predicted, and by how much the prediction was
  /// then corrected. In innovations the rod is where the sensor is: on a second mass too.
  struct Predicted {
    std::vector<double> rod_m;
    std::vector<double> reading_m;
    std::vector<double> correction_m;
  };
  [[nodiscard]] const Predicted& predicted() const { return predicted_; }

 private:
  void take(const Eigen::MatrixXd& points);
  void run(const Eigen::MatrixXd& points, const Eigen::MatrixXd& added_V,
           const Eigen::MatrixXd& added_N, Eigen::MatrixXd& residuals_m, Chambers* chambers);
  void predict(const Eigen::MatrixXd& points, const Eigen::MatrixXd& added_V,
               const Eigen::MatrixXd& added_N, std::span<const InnovationGains* const> gains,
               Eigen::MatrixXd& residuals_m);

  const Dataset* record_;
  std::vector<FreeParameter> parameters_;
  double observer_per_s_;
  std::unique_ptr<plant_sim::Ensemble> ensemble_;
  plant_sim::EnsembleSchedule schedule_;
  /// Place of a free parameter: in the ensemble, or a number of a change.
  struct Slot {
    std::size_t index = 0;
    bool of_change = false;
    bool of_other_record = false;
  };
  std::vector<Slot> slots_;
  std::size_t position_;  ///< state of the ensemble
  std::vector<double> speed_mps_;
  Predicted predicted_;
};

/// Integration step for a record: the model's own, adjusted to divide the sample time.
[[nodiscard]] double step_for(const plant_sim::ModelFile& model, double sample_time_s);

}  // namespace estimator::greybox
