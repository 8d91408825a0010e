#include "estimator/greybox/disturbance/noise_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>

#include "estimator/greybox/disturbance/batch_newton.h"
#include "estimator/greybox/disturbance/simulated_lines.h"
#include "estimator/greybox/observer_simulation.h"
#include "estimator/linear_algebra/decompositions.h"
#include "estimator/parallel.h"

namespace estimator::greybox::disturbance {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Walk of the position per sample over the sensor's noise: the gain of a stationary filter that
/// knows nothing else, so that the least is a tenth of the weak observer's.
constexpr double kLeastWalk_ratio = 0.1;
constexpr double kMostWalk_ratio = 150.0;
/// Turns of the corner frequency over the longest record: a slower force is a constant to it.
constexpr double kLeastCorner_turns = 2.0;
constexpr double kMostCorner_ratio = 0.2;  ///< share of the sampling rate
/// Least sensor noise over the floor: the floor counts a resonance near half the sampling rate as
/// noise.
constexpr double kLeastSensor_ratio = 0.05;
/// Greatest disturbance, in those that move the rod by the sensor's noise within a second.
constexpr double kMostDisturbance_units = 1e8;
/// Largest step of a line's frequency, in bins of the longest record.
constexpr double kMostStep_bins = 0.25;

using Point = SearchPoint;

/// RMS of the position that a constant unit of F moves within a second.
double reach_per_unit_m(const Linearisations& models, const FitDataset& data) {
  double sum_m2 = 0.0;
  double windows = 0.0;
  for (std::size_t r = 0; r < models.size(); ++r) {
    const auto length =
        static_cast<std::size_t>(std::max(1.0, std::round(1.0 / data.records[r].sample_time_s)));
    const std::size_t samples = models[r].transition.size();
    for (std::size_t from = 0; from + length <= samples; from += length) {
      StateVector z = StateVector::Zero();
      for (std::size_t k = from; k < from + length; ++k) {
        z[kMostStates - 1] = 1.0;
        z = (models[r].transition[k] * z).eval();
      }
      sum_m2 += z[0] * z[0];
      windows += 1.0;
    }
  }
  return std::sqrt(sum_m2 / std::max(windows, 1.0));
}

double longest_s(const FitDataset& data) {
  double longest = 0.0;
  for (const Dataset& record : data.records) {
    longest = std::max(longest, record.sample_time_s * static_cast<double>(record.size()));
  }
  return longest;
}

MatrixXd line_responses(const Linearisation& model, const Dataset& record,
                        const InnovationGains& gains, const std::vector<SpectralLine>& lines) {
  MatrixXd columns(static_cast<Index>(record.size()), 2 * static_cast<Index>(lines.size()));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    columns.middleCols(2 * static_cast<Index>(i), 2) =
        line_response(model, record, gains, lines[i]);
  }
  return columns;
}

/// The known lines' part of the readings of record r; empty: none is known.
VectorXd known_lines_m(const plant_sim::ModelFile& model, const Dataset& record, std::size_t r,
                       const std::vector<FreeParameter>& parameters, const VectorXd& theta,
                       const NoiseModel& noise) {
  if (noise.waves.empty()) return {};
  std::vector<SpectralLine> known(noise.lines.begin(),
                                  noise.lines.begin() + static_cast<Index>(noise.waves.size()));
  std::vector<Eigen::Vector2d> waves;
  for (const std::vector<Eigen::Vector2d>& of_line : noise.waves) waves.push_back(of_line[r]);
  return simulated_lines_m(model, record, parameters, theta, known, waves, noise.force_place);
}

/// Columns of very different sizes (m per Pa, per N) scaled alike before their rank is judged.
MatrixXd basis_of(MatrixXd columns) {
  for (Index i = 0; i < columns.cols(); ++i) {
    const double norm = columns.col(i).norm();
    if (norm > 0.0) columns.col(i) /= norm;
  }
  return linear_algebra::orthonormal_basis(columns, 1e-6);
}

class Likelihood {
 public:
  Likelihood(const plant_sim::ModelFile& model, const FitDataset& data,
             const std::vector<FreeParameter>& parameters, const VectorXd& theta,
             const Linearisations& models, const NoiseModel& noise, unsigned threads)
      : data_(&data), theta_(&theta), models_(&models), lines_(&noise.lines), threads_(threads) {
    for (const Dataset& record : data.records) {
      Dataset& plain = records_.emplace_back(record);
      plain.innovations.reset();
    }
    runs_.resize(threads > 1 ? kMostGroups : 1);
    for (const Dataset& record : records_) {
      line_m_.push_back(known_lines_m(model, record, line_m_.size(), parameters, theta, noise));
      for (std::vector<ObserverSimulation>& runs : runs_) {
        runs.emplace_back(model, record, parameters);
      }
    }
  }

  /// -2 log L of points, at most sixteen.
  std::vector<double> operator()(const std::vector<Point>& points) {
    std::vector<double> cost(points.size(), 0.0);
    const std::size_t groups = (points.size() + kTogether - 1) / kTogether;
    const unsigned own = groups > 1 ? 1 : threads_;
    in_parallel(groups, threads_, [&](std::size_t group) {
      const std::size_t from = group * kTogether;
      const std::size_t count = std::min(kTogether, points.size() - from);
      evaluate(std::span(points).subspan(from, count), runs_[std::min(group, runs_.size() - 1)],
               own, std::span(cost).subspan(from, count));
    });
    return cost;
  }

 private:
  static constexpr std::size_t kTogether = 8;
  static constexpr std::size_t kMostGroups = 2;

  void evaluate(std::span<const Point> points, std::vector<ObserverSimulation>& runs,
                unsigned threads, std::span<double> cost) const {
    for (std::size_t r = 0; r < runs.size(); ++r) {
      std::vector<NoiseParameters> noise;
      for (const Point& point : points) noise.push_back(noise_of(point));
      std::vector<KalmanGains> gains =
          kalman_gains((*models_)[r], records_[r], noise, data_->noise_floor_m);
      std::vector<MatrixXd> lines(points.size());
      if (!lines_->empty()) {
        in_parallel(points.size(), threads, [&](std::size_t i) {
          lines[i] = basis_of(line_responses((*models_)[r], records_[r], gains[i].gains, *lines_));
        });
      }
      std::vector<InnovationGains> each;
      each.reserve(gains.size());
      for (KalmanGains& one : gains) {
        each.push_back(std::move(one.gains));
        each.back().line_m = line_m_[r];
      }
      MatrixXd residuals_m;
      runs[r].innovations(theta_->replicate(1, static_cast<Index>(points.size())), each,
                          residuals_m);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto e = residuals_m.col(static_cast<Index>(i));
        double square_m2 = e.squaredNorm();
        if (lines[i].cols() > 0) square_m2 -= (lines[i].transpose() * e).squaredNorm();
        const double value =
            square_m2 / (data_->noise_floor_m * data_->noise_floor_m) + gains[i].log_determinant;
        cost[i] += std::isfinite(value) ? value : 1e300;
      }
    }
  }

  const FitDataset* data_;
  const VectorXd* theta_;
  const Linearisations* models_;
  const std::vector<SpectralLine>* lines_;
  unsigned threads_;
  std::vector<Dataset> records_;
  std::vector<std::vector<ObserverSimulation>> runs_;  ///< per group of points, per record
  std::vector<VectorXd> line_m_;                       ///< per record
};

}  // namespace

double most_corner_Hz(const FitDataset& data) { return kMostCorner_ratio / data.sample_time_s; }

NoiseParameters noise_of(const SearchPoint& point) {
  return {std::exp(point[0] - 0.5 * point[1]), std::exp(point[1]), std::exp(point[2]),
          std::exp(point[3])};
}

SearchPoint point_of(const NoiseParameters& noise) {
  return {std::log(noise.disturbance_sd * std::sqrt(noise.corner_Hz)), std::log(noise.corner_Hz),
          std::log(noise.walk_m), std::log(noise.sensor_m)};
}

namespace {

/// A disturbance that moves the rod by the sensor's noise within a second; an axis with little
/// damping and a fine sensor moves by a million times as much.
double unit_of(const Linearisations& models, const FitDataset& data) {
  return data.noise_floor_m / std::max(reach_per_unit_m(models, data), 1e-300);
}

/// The walk that the weak observer of a simulation assumes.
double observer_walk_m(const FitDataset& data) {
  return kObserver_per_s * data.sample_time_s * data.noise_floor_m;
}

}  // namespace

SearchBounds noise_bounds(const Linearisations& models, const FitDataset& data) {
  const double floor_m = data.noise_floor_m;
  const double unit = unit_of(models, data);
  const double walk_m = observer_walk_m(data);
  return {Point(std::log(1e-2 * unit), std::log(kLeastCorner_turns / longest_s(data)),
                std::log(kLeastWalk_ratio * walk_m), std::log(kLeastSensor_ratio * floor_m)),
          Point(std::log(kMostDisturbance_units * unit), std::log(most_corner_Hz(data)),
                std::log(kMostWalk_ratio * walk_m), std::log(data.most_sensor_ratio * floor_m))};
}

Linearisations linearise(const plant_sim::ModelFile& model, const FitDataset& data,
                         const std::vector<FreeParameter>& parameters, const VectorXd& theta,
                         double force_place) {
  Linearisations models;
  models.reserve(data.records.size());
  for (const Dataset& record : data.records) {
    models.push_back(linearise(model, record, parameters, theta, force_place));
  }
  return models;
}

void score_every_sample(FitDataset& data) {
  data.training_mask = data.all_mask;
  data.validation_mask = data.all_mask;
}

InnovationData innovation_data(const plant_sim::ModelFile& model, const FitDataset& data,
                               const std::vector<FreeParameter>& parameters, const VectorXd& theta,
                               const Linearisations& models, const NoiseModel& noise) {
  InnovationData result{data, 0.0};
  for (std::size_t r = 0; r < data.records.size(); ++r) {
    Dataset& record = result.data.records[r];
    KalmanGains gains = kalman_gains(models[r], record, noise.noise, data.noise_floor_m);
    if (!noise.lines.empty()) {
      gains.gains.lines = basis_of(line_responses(models[r], record, gains.gains, noise.lines));
      gains.gains.line_m = known_lines_m(model, record, r, parameters, theta, noise);
    }
    result.log_determinant += gains.log_determinant;
    record.innovations = std::make_shared<const InnovationGains>(std::move(gains.gains));
  }
  score_every_sample(result.data);
  return result;
}

namespace {

double middle_s(const Dataset& record) { return 0.5 * (record.t_s.front() + record.t_s.back()); }

/// The record's innovations from which no line was projected out.
VectorXd plain_innovations(const plant_sim::ModelFile& model, Dataset record,
                           const std::vector<FreeParameter>& parameters, const VectorXd& theta,
                           const InnovationGains& gains) {
  record.innovations = std::make_shared<const InnovationGains>(gains);
  ObserverSimulation run(model, record, parameters);
  MatrixXd innovations;
  run.residuals(theta, innovations);
  return innovations.col(0);
}

InnovationGains without_lines(const Dataset& record) {
  InnovationGains gains = *record.innovations;
  gains.lines.resize(0, 0);
  return gains;
}

}  // namespace

void update_waves(const plant_sim::ModelFile& model, const FitDataset& data,
                  const std::vector<FreeParameter>& parameters, const VectorXd& theta,
                  const Linearisations& models, NoiseModel& noise) {
  if (noise.lines.empty()) return;
  noise.waves.resize(noise.lines.size(),
                     std::vector<Eigen::Vector2d>(data.records.size(), Eigen::Vector2d::Zero()));
  for (std::size_t r = 0; r < data.records.size(); ++r) {
    const Dataset& record = data.records[r];
    const InnovationGains gains = without_lines(record);
    const std::vector<Eigen::Vector2d> more =
        fit_waves(models[r], record, gains, noise.lines,
                  plain_innovations(model, record, parameters, theta, gains));
    for (std::size_t i = 0; i < more.size(); ++i) noise.waves[i][r] += more[i];
  }
}

void tune_frequencies(const plant_sim::ModelFile& model, const FitDataset& data,
                      const std::vector<FreeParameter>& parameters, const VectorXd& theta,
                      const Linearisations& models, NoiseModel& noise) {
  const auto count = static_cast<Index>(noise.waves.size());
  if (count == 0) return;
  // normal equations of the steps, the waves free
  MatrixXd normal = MatrixXd::Zero(count, count);
  VectorXd slope = VectorXd::Zero(count);
  double longest_s = 0.0;
  for (std::size_t r = 0; r < data.records.size(); ++r) {
    const Dataset& record = data.records[r];
    longest_s = std::max(longest_s, record.t_s.back() - record.t_s.front());
    const InnovationGains gains = without_lines(record);
    const MatrixXd waves = basis_of(line_responses(models[r], record, gains, noise.lines));
    const auto apart = [&](const VectorXd& x) -> VectorXd {
      return x - waves * (waves.transpose() * x);
    };
    MatrixXd slopes(static_cast<Index>(record.size()), count);
    for (Index i = 0; i < count; ++i) {
      const auto line = static_cast<std::size_t>(i);
      slopes.col(i) = apart(frequency_sensitivity(models[r], record, gains, noise.lines[line],
                                                  noise.waves[line][r], middle_s(record)));
    }
    normal += slopes.transpose() * slopes;
    slope += slopes.transpose() * apart(plain_innovations(model, record, parameters, theta, gains));
  }
  const VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const MatrixXd scaled =
      scale.cwiseInverse().asDiagonal() * normal * scale.cwiseInverse().asDiagonal();
  const VectorXd steps_Hz =
      linear_algebra::shortest_least_squares(scaled, VectorXd(slope.cwiseQuotient(scale)))
          .x.cwiseQuotient(scale);
  const double most_Hz = kMostStep_bins / longest_s;
  for (std::size_t i = 0; i < noise.waves.size(); ++i) {
    const double by_Hz = std::clamp(steps_Hz[static_cast<Index>(i)], -most_Hz, most_Hz);
    if (!std::isfinite(by_Hz)) continue;
    noise.lines[i].frequency_Hz += by_Hz;
    for (std::size_t r = 0; r < data.records.size(); ++r) {
      noise.waves[i][r] = with_frequency_moved(noise.waves[i][r], by_Hz, middle_s(data.records[r]));
    }
  }
}

double minus_two_log_likelihood(const plant_sim::ModelFile& model, const FitDataset& data,
                                const std::vector<FreeParameter>& parameters, const VectorXd& theta,
                                const Linearisations& models, const NoiseModel& noise) {
  return Likelihood(model, data, parameters, theta, models, noise, 1)({point_of(noise.noise)})
      .front();
}

NoiseEstimate estimate_noise(const plant_sim::ModelFile& model, const FitDataset& data,
                             const std::vector<FreeParameter>& parameters, const VectorXd& theta,
                             const Linearisations& models, const NoiseModel& start,
                             unsigned threads, double enough) {
  Likelihood likelihood(model, data, parameters, theta, models, start, threads);
  const double floor_m = data.noise_floor_m;
  const double unit = unit_of(models, data);
  const double walk_m = observer_walk_m(data);
  const SearchBounds bounds = noise_bounds(models, data);
  const auto within = [&](const Point& point) -> Point {
    return point.cwiseMax(bounds.lower).cwiseMin(bounds.upper);
  };
  std::vector<Point> points;
  for (const double ratio : {0.1, 3.0, 30.0, 300.0, 3e3, 3e4, 3e5, 3e6}) {
    for (const double corner_Hz : {0.4, 4.0}) {
      points.push_back(within(point_of({ratio * unit, corner_Hz, walk_m, floor_m})));
    }
  }
  if (start.noise.sensor_m > 0.0) points.back() = within(point_of(start.noise));
  std::vector<double> costs = likelihood(points);
  const auto least = std::min_element(costs.begin(), costs.end());
  Minimum best{points[static_cast<std::size_t>(least - costs.begin())], *least};
  if (std::isfinite(enough)) {
    best = minimise([&](const std::vector<Point>& at) { return likelihood(at); }, best, bounds,
                    enough, threads > 1 ? Lookahead::yes : Lookahead::no);
  }
  return {{noise_of(best.at), start.lines, start.waves, start.force_place}, best.value};
}

}  // namespace estimator::greybox::disturbance
