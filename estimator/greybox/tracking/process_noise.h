// Process disturbance of a rig: its noise model as learned on the healthy rig, and what of it a
// window needs and shows.
//
// With a noise model a window's residuals are scaled innovations of a one-step predictor
// (innovation_gains.h): white, with the healthy error as their standard deviation. The gains belong
// to one window and are frozen for every fit to it, so that chi-squares can be compared.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "estimator/greybox/disturbance/noise_model.h"
#include "estimator/greybox/observer_simulation.h"
#include "estimator/greybox/tracking/window_fit.h"
#include "estimator/state_archive.h"

namespace estimator::greybox::tracking {

/// Size of a disturbance.
struct DisturbanceLevel {
  double random = 0.0;  ///< RMS of the random part, N (m/s where the plant has no force)
  std::vector<double> line_values;  ///< amplitude of each line, in the unit of its site
};

using disturbance::LineSite;

struct ProcessNoise {
  bool force = true;  ///< the random part is a force, N; otherwise a speed, m/s
  disturbance::NoiseModel model;
  DisturbanceLevel healthy;
  /// Covariance of the baseline's tracked parameters, search units.
  Eigen::MatrixXd covariance;

  /// "force" or "speed"; "pressure", "sensor".
  [[nodiscard]] std::string site_name(LineSite site) const;
  /// "N" or "m/s"; "Pa", "m": unit of a line's amplitude.
  [[nodiscard]] std::string unit_of(LineSite site) const;

  /// Table of the baseline file.
  void visit(config::schema::Visitor& v);
  /// Bit-exact (state_archive.h); `tracked`: number of tracked parameters.
  void serialize(estimator::StateArchive& archive, std::size_t tracked);
};

inline constexpr std::size_t kMostLines = 4;

/// Gains and disturbance levels of windows of one model. Not thread-safe.
class WindowNoise {
 public:
  WindowNoise(const plant_sim::ModelFile& model, std::vector<FreeParameter> parameters,
              double sample_time_s);

  /// Gains about the trajectory with `theta`; `floor_m`: standard deviation of the scaled
  /// innovations.
  [[nodiscard]] std::shared_ptr<const InnovationGains> gains(const WindowData& data,
                                                             const Eigen::VectorXd& theta,
                                                             const disturbance::NoiseModel& noise,
                                                             double floor_m);

  /// Maximum-likelihood size of the random part, within a factor of kMostChange of the model's, and
  /// amplitudes of the lines in one window.
  [[nodiscard]] DisturbanceLevel level(const WindowData& data, const Eigen::VectorXd& theta,
                                       const disturbance::NoiseModel& noise, double floor_m);

  static constexpr double kMostChange = 4.0;

 private:
  void take(const WindowData& data);

  plant_sim::ModelFile model_;
  std::vector<FreeParameter> parameters_;
  FitDataset data_;
};

}  // namespace estimator::greybox::tracking
