// Gains of predictors that follow the parameters, for a search that moves both.
//
// Each point (theta, noise) costs a linearisation along the whole record. A point that serves a
// slope alone, a difference step away from a trial in one parameter, takes the gains that follow as
// they did where this was last computed, a few trials ago at most:
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
#include "estimator/nonlinear/problem.h"

namespace estimator::greybox::disturbance {

/// Number of a point's last coordinates, the noise parameters.
inline constexpr Eigen::Index kNoiseCoordinates = SearchPoint::RowsAtCompileTime;

class FollowingGains {
 public:
  /// `unknowns`: the search's, for their difference steps. The references must outlive the object.
  FollowingGains(const plant_sim::ModelFile& model, const FitDataset& data,
                 const std::vector<FreeParameter>& parameters,
                 std::vector<nonlinear::Unknown> unknowns, double force_place, unsigned threads);

  /// Gains at points (theta, then the noise parameters of point_of()), one a column: per record and
  /// point. The first point is a new trial, unless it is the last one or a difference step away
  /// from it; slopes are learned from the points about the trial. Not safe for several threads.
  [[nodiscard]] std::vector<std::vector<KalmanGains>> at(const Eigen::MatrixXd& points);

 private:
  struct Slope {
    Eigen::MatrixXd gain;
    Eigen::VectorXd scale;
    double log_determinant = 0.0;
    int trials = 0;  ///< since it was learned
  };
  /// The trial as one record shows it.
  struct Trial {
    KalmanGains gains;
    std::vector<std::optional<Slope>> slopes;  ///< per parameter
  };

  void begin_trial(const Eigen::VectorXd& point);
  /// The coordinate in which alone a point is a difference step away from the trial.
  [[nodiscard]] std::optional<Eigen::Index> coordinate_beside(const Eigen::VectorXd& point) const;
  /// The same, where it is a parameter.
  [[nodiscard]] std::optional<std::size_t> parameter_beside(const Eigen::VectorXd& point) const;
  [[nodiscard]] bool has_slope(std::size_t parameter) const;
  /// Columns of points by their theta: those of a group share what is linearised.
  [[nodiscard]] static std::vector<std::vector<Eigen::Index>> columns_by_theta(
      const Eigen::MatrixXd& points, const std::vector<Eigen::Index>& columns);
  /// Gains at columns of the same theta.
  [[nodiscard]] std::vector<KalmanGains> computed(const Eigen::MatrixXd& points,
                                                  const std::vector<Eigen::Index>& columns,
                                                  const Dataset& record) const;
  void learn(const Eigen::VectorXd& point, const KalmanGains& gains, Trial& trial) const;
  /// None where the trial has other states than that of the slope.
  [[nodiscard]] std::optional<KalmanGains> followed(const Eigen::VectorXd& point,
                                                    const Trial& trial) const;

  const plant_sim::ModelFile& model_;
  const FitDataset& data_;
  const std::vector<FreeParameter>& parameters_;
  std::vector<nonlinear::Unknown> unknowns_;
  double force_place_;
  unsigned threads_;
  Eigen::VectorXd trial_point_;  ///< empty: there was no trial
  std::vector<Trial> trials_;    ///< per record
};

}  // namespace estimator::greybox::disturbance
