// Gains of predictors that follow the parameters, for a search that moves both.
//
// Each point (theta, noise) costs a linearisation along the whole record. A point that serves a
// slope alone, beside a trial from which it differs in one parameter, takes the gains that follow
// as they did where this was last computed:
//
//   K(theta + h e_j) = K(theta) + h K'_j,   K'_j = (K(theta0 + h0 e_j) - K(theta0)) / h0
//
// and the scales and the log determinant alike. Trials themselves are exact.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "estimator/greybox/disturbance/kalman_gains.h"
#include "estimator/greybox/disturbance/noise_model.h"

namespace estimator::greybox::disturbance {

/// The last coordinates of a point: the noise parameters.
inline constexpr Eigen::Index kNoiseCoordinates = SearchPoint::RowsAtCompileTime;

class FollowingGains {
 public:
  /// The arguments must outlive the object.
  FollowingGains(const plant_sim::ModelFile& model, const FitDataset& data,
                 const std::vector<FreeParameter>& parameters, double force_place,
                 unsigned threads);

  /// Gains at points (theta, then the noise parameters of point_of()), one a column: per record and
  /// point. The first is a trial, or all differ from the last trial in one coordinate each. Not
  /// from several threads.
  [[nodiscard]] std::vector<std::vector<KalmanGains>> at(const Eigen::MatrixXd& points);

 private:
  struct Slope {
    Eigen::MatrixXd gain;
    Eigen::VectorXd scale;
    double log_determinant = 0.0;
  };
  /// Of one record.
  struct Trial {
    KalmanGains gains;
    std::vector<std::optional<Slope>> slopes;  ///< per parameter
  };

  /// The parameter in which alone a point differs from the trial; none: there is no trial, or they
  /// differ in a noise parameter or in several.
  [[nodiscard]] std::optional<std::size_t> parameter_beside_trial(
      const Eigen::VectorXd& point) const;
  /// At points of the same theta.
  [[nodiscard]] std::vector<KalmanGains> computed(const Eigen::MatrixXd& points,
                                                  const std::vector<Eigen::Index>& columns,
                                                  const Dataset& record) const;
  void learn(const Eigen::VectorXd& point, const KalmanGains& gains, Trial& trial) const;
  [[nodiscard]] bool has_slope(std::size_t parameter) const;
  /// None where the trial has other states than that of the slope.
  [[nodiscard]] std::optional<KalmanGains> followed(const Eigen::VectorXd& point,
                                                    const Trial& trial) const;

  const plant_sim::ModelFile& model_;
  const FitDataset& data_;
  const std::vector<FreeParameter>& parameters_;
  double force_place_;
  unsigned threads_;
  Eigen::VectorXd at_;         ///< the trial's point; empty: there was none
  std::vector<Trial> trials_;  ///< per record
};

}  // namespace estimator::greybox::disturbance
