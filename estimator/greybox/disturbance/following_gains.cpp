#include "estimator/greybox/disturbance/following_gains.h"

#include <algorithm>
#include <utility>

#include "estimator/parallel.h"

namespace estimator::greybox::disturbance {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Coordinates in which two points differ.
Index differences(const VectorXd& one, const VectorXd& other) {
  return (one.array() != other.array()).count();
}

}  // namespace

FollowingGains::FollowingGains(const plant_sim::ModelFile& model, const FitDataset& data,
                               const std::vector<FreeParameter>& parameters, double force_place,
                               unsigned threads)
    : model_(model),
      data_(data),
      parameters_(parameters),
      force_place_(force_place),
      threads_(threads),
      trials_(data.records.size()) {
  for (Trial& trial : trials_) trial.slopes.resize(parameters.size());
}

std::vector<std::vector<KalmanGains>> FollowingGains::at(const MatrixXd& points) {
  const VectorXd first = points.col(0);
  const bool is_trial = at_.size() == 0 || differences(first, at_) > 1;
  if (is_trial) at_ = first;
  std::vector<std::vector<Index>> alike;  // those that share what is linearised
  std::vector<Index> follow;
  for (Index column = 0; column < points.cols(); ++column) {
    const VectorXd point = points.col(column);
    const std::optional<std::size_t> beside = parameter_beside_trial(point);
    if (is_trial && beside && has_slope(*beside)) {
      follow.push_back(column);
      continue;
    }
    const auto same = std::find_if(alike.begin(), alike.end(), [&](const auto& columns) {
      return points.col(columns.front()).head(points.rows() - kNoiseCoordinates) ==
             point.head(points.rows() - kNoiseCoordinates);
    });
    if (same == alike.end()) {
      alike.push_back({column});
    } else {
      same->push_back(column);
    }
  }
  const std::size_t records = trials_.size();
  std::vector<std::vector<KalmanGains>> found(records * alike.size());
  in_parallel(found.size(), threads_, [&](std::size_t k) {
    found[k] = computed(points, alike[k / records], data_.records[k % records]);
  });
  std::vector<std::vector<KalmanGains>> result(
      records, std::vector<KalmanGains>(static_cast<std::size_t>(points.cols())));
  for (std::size_t k = 0; k < found.size(); ++k) {
    Trial& trial = trials_[k % records];
    if (is_trial && k < records) trial.gains = found[k].front();
    const std::vector<Index>& columns = alike[k / records];
    for (std::size_t i = 0; i < columns.size(); ++i) {
      learn(points.col(columns[i]), found[k][i], trial);
      result[k % records][static_cast<std::size_t>(columns[i])] = std::move(found[k][i]);
    }
  }
  for (const Index column : follow) {
    for (std::size_t r = 0; r < records; ++r) {
      std::optional<KalmanGains> gains = followed(points.col(column), trials_[r]);
      if (!gains) gains = std::move(computed(points, {column}, data_.records[r]).front());
      result[r][static_cast<std::size_t>(column)] = *std::move(gains);
    }
  }
  return result;
}

std::optional<std::size_t> FollowingGains::parameter_beside_trial(const VectorXd& point) const {
  if (differences(point, at_) != 1) return {};
  Index i = 0;
  while (point[i] == at_[i]) ++i;
  if (i >= point.size() - kNoiseCoordinates) return {};
  return static_cast<std::size_t>(i);
}

bool FollowingGains::has_slope(std::size_t parameter) const {
  return std::all_of(trials_.begin(), trials_.end(),
                     [&](const Trial& trial) { return trial.slopes[parameter].has_value(); });
}

std::vector<KalmanGains> FollowingGains::computed(const MatrixXd& points,
                                                  const std::vector<Index>& columns,
                                                  const Dataset& record) const {
  std::vector<NoiseParameters> noise;
  noise.reserve(columns.size());
  for (const Index column : columns)
    noise.push_back(noise_of(points.col(column).tail<kNoiseCoordinates>()));
  const VectorXd theta = points.col(columns.front()).head(points.rows() - kNoiseCoordinates);
  return kalman_gains(linearise(model_, record, parameters_, theta, force_place_), record, noise,
                      data_.noise_floor_m);
}

void FollowingGains::learn(const VectorXd& point, const KalmanGains& gains, Trial& trial) const {
  const std::optional<std::size_t> i = parameter_beside_trial(point);
  if (!i) return;
  const double by = point[static_cast<Index>(*i)] - at_[static_cast<Index>(*i)];
  const KalmanGains& at = trial.gains;
  if (gains.gains.states != at.gains.states) return;  // a second mass comes in or goes
  trial.slopes[*i] =
      Slope{(gains.gains.gain - at.gains.gain) / by, (gains.gains.scale - at.gains.scale) / by,
            (gains.log_determinant - at.log_determinant) / by};
}

std::optional<KalmanGains> FollowingGains::followed(const VectorXd& point,
                                                    const Trial& trial) const {
  const std::size_t i = parameter_beside_trial(point).value();
  const double by = point[static_cast<Index>(i)] - at_[static_cast<Index>(i)];
  const Slope& slope = trial.slopes[i].value();
  if (slope.gain.rows() != trial.gains.gains.gain.rows()) return {};
  KalmanGains result = trial.gains;
  result.gains.gain += by * slope.gain;
  result.gains.scale += by * slope.scale;
  result.log_determinant += by * slope.log_determinant;
  return result;
}

}  // namespace estimator::greybox::disturbance
