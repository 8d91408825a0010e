// Disturbances of a rig beyond its sensor's noise, estimated by maximum likelihood of the
// innovations of a model with given parameters.
//
//   -2 log L = sum over valid samples of  log S(k) + e(k)^2 / S(k)
//
// Searched are the standard deviation and corner of the disturbance F, the walk of the position and
// the sensor's noise, within bounds that keep a missing effect from passing as noise without limit.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/greybox/disturbance/batch_newton.h"
#include "estimator/greybox/disturbance/kalman_gains.h"
#include "estimator/greybox/disturbance/spectral_lines.h"
#include "estimator/greybox/fit_dataset.h"
#include "estimator/greybox/free_parameter.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox::disturbance {

/// Highest corner of the disturbance that is searched for: one that ends there is white.
[[nodiscard]] double most_corner_Hz(const FitDataset& data);

struct NoiseModel {
  NoiseParameters noise;
  std::vector<SpectralLine> lines;
  /// Amplitudes of sine and cosine found so far, per line and record; none yet for further lines.
  std::vector<std::vector<Eigen::Vector2d>> waves;
  /// Place of a random force, as plant_sim::Ensemble::place_disturbance().
  double force_place = plant_sim::kPlaceOfSensor;
};

/// One per record of a data set.
using Linearisations = std::vector<Linearisation>;

[[nodiscard]] Linearisations linearise(const plant_sim::ModelFile& model, const FitDataset& data,
                                       const std::vector<FreeParameter>& parameters,
                                       const Eigen::VectorXd& theta,
                                       double force_place = plant_sim::kPlaceOfSensor);

/// The data set with innovations as residuals; every valid sample is fitted and scored.
struct InnovationData {
  FitDataset data;
  double log_determinant = 0.0;  ///< KalmanGains', over all records
};
/// `models`: linearised with `theta`.
[[nodiscard]] InnovationData innovation_data(const plant_sim::ModelFile& model,
                                             const FitDataset& data,
                                             const std::vector<FreeParameter>& parameters,
                                             const Eigen::VectorXd& theta,
                                             const Linearisations& models, const NoiseModel& noise);

/// Sets the training and the validation mask to all valid samples.
void score_every_sample(FitDataset& data);

/// Adds to the waves of `noise` what is left of its lines in the innovations of `data`, which must
/// come from `noise`.
void update_waves(const plant_sim::ModelFile& model, const FitDataset& data,
                  const std::vector<FreeParameter>& parameters, const Eigen::VectorXd& theta,
                  const Linearisations& models, NoiseModel& noise);

/// Moves the frequencies of lines whose waves are known by a Gauss-Newton step of at most a quarter
/// of a bin; arguments as above.
void tune_frequencies(const plant_sim::ModelFile& model, const FitDataset& data,
                      const std::vector<FreeParameter>& parameters, const Eigen::VectorXd& theta,
                      const Linearisations& models, NoiseModel& noise);

struct NoiseEstimate {
  NoiseModel noise;
  double minus_two_log_likelihood = 0.0;  ///< up to a constant; residuals per noise floor
};

/// -2 log L with a noise model as it is, its waves included.
[[nodiscard]] double minus_two_log_likelihood(const plant_sim::ModelFile& model,
                                              const FitDataset& data,
                                              const std::vector<FreeParameter>& parameters,
                                              const Eigen::VectorXd& theta,
                                              const Linearisations& models,
                                              const NoiseModel& noise);

/// Noise parameters as they are searched: logarithms of the disturbance's intensity, its standard
/// deviation times the root of its corner, of its corner, walk and sensor noise. Above the corner
/// the intensity alone is seen.
[[nodiscard]] SearchPoint point_of(const NoiseParameters& noise);
[[nodiscard]] NoiseParameters noise_of(const SearchPoint& point);
/// Bounds of the search, which keep a missing effect from passing as noise without limit.
[[nodiscard]] SearchBounds noise_bounds(const Linearisations& models, const FitDataset& data);

/// Fall of -2 log L below which a step of the search for a noise model is its last.
inline constexpr double kLastNoiseStep = 0.1;

/// `start`: lines are kept, its noise is one of the starts when its sensor_m is positive. `enough`:
/// as kLastNoiseStep; infinite: the likeliest of a coarse grid will do.
[[nodiscard]] NoiseEstimate estimate_noise(const plant_sim::ModelFile& model,
                                           const FitDataset& data,
                                           const std::vector<FreeParameter>& parameters,
                                           const Eigen::VectorXd& theta,
                                           const Linearisations& models, const NoiseModel& start,
                                           unsigned threads, double enough = kLastNoiseStep);

}  // namespace estimator::greybox::disturbance
