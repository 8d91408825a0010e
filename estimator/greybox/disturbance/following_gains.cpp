#include "estimator/greybox/disturbance/following_gains.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/parallel.h"

namespace estimator::greybox::disturbance {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Trials after which a slope is computed again.
constexpr int kMostTrials = 3;
/// Distance beyond a difference step that is rounding.
constexpr double kRounding_ratio = 1.001;

Index parameters_in(const MatrixXd& points) { return points.rows() - kNoiseCoordinates; }

}  // namespace

FollowingGains::FollowingGains(const plant_sim::ModelFile& model, const FitDataset& data,
                               const std::vector<FreeParameter>& parameters,
                               std::vector<nonlinear::Unknown> unknowns, double force_place,
                               unsigned threads)
    : model_(model),
      data_(data),
      parameters_(parameters),
      unknowns_(std::move(unknowns)),
      force_place_(force_place),
      threads_(threads),
      trials_(data.records.size()) {
  for (Trial& trial : trials_) trial.slopes.resize(parameters.size());
}

std::vector<std::vector<KalmanGains>> FollowingGains::at(const MatrixXd& points) {
  const VectorXd first = points.col(0);
  const bool is_trial =
      trial_point_.size() == 0 || (first != trial_point_ && !coordinate_beside(first));
  if (is_trial) begin_trial(first);
  std::vector<Index> exact_columns;
  std::vector<Index> followed_columns;
  for (Index column = 0; column < points.cols(); ++column) {
    const std::optional<std::size_t> beside = parameter_beside(points.col(column));
    const bool follows = is_trial && beside && has_slope(*beside);
    (follows ? followed_columns : exact_columns).push_back(column);
  }
  const std::vector<std::vector<Index>> groups = columns_by_theta(points, exact_columns);
  const std::size_t records = trials_.size();
  std::vector<std::vector<KalmanGains>> found(records * groups.size());
  in_parallel(found.size(), threads_, [&](std::size_t k) {
    found[k] = computed(points, groups[k / records], data_.records[k % records]);
  });
  std::vector<std::vector<KalmanGains>> result(
      records, std::vector<KalmanGains>(static_cast<std::size_t>(points.cols())));
  for (std::size_t k = 0; k < found.size(); ++k) {
    Trial& trial = trials_[k % records];
    if (is_trial && k < records) trial.gains = found[k].front();
    const std::vector<Index>& columns = groups[k / records];
    for (std::size_t i = 0; i < columns.size(); ++i) {
      learn(points.col(columns[i]), found[k][i], trial);
      result[k % records][static_cast<std::size_t>(columns[i])] = std::move(found[k][i]);
    }
  }
  for (const Index column : followed_columns) {
    for (std::size_t r = 0; r < records; ++r) {
      std::optional<KalmanGains> gains = followed(points.col(column), trials_[r]);
      if (!gains) gains = std::move(computed(points, {column}, data_.records[r]).front());
      result[r][static_cast<std::size_t>(column)] = *std::move(gains);
    }
  }
  return result;
}

void FollowingGains::begin_trial(const VectorXd& point) {
  trial_point_ = point;
  for (Trial& trial : trials_) {
    for (std::optional<Slope>& slope : trial.slopes) {
      if (slope && ++slope->trials > kMostTrials) slope.reset();
    }
  }
}

std::optional<Index> FollowingGains::coordinate_beside(const VectorXd& point) const {
  std::optional<Index> found;
  for (Index i = 0; i < point.size(); ++i) {
    if (point[i] == trial_point_[i]) continue;
    if (found) return {};
    found = i;
  }
  if (!found) return {};
  const nonlinear::Unknown& unknown = unknowns_[static_cast<std::size_t>(*found)];
  const double step =
      std::max(unknown.step, unknown.relative_step * std::abs(trial_point_[*found]));
  if (std::abs(point[*found] - trial_point_[*found]) > kRounding_ratio * step) return {};
  return found;
}

std::optional<std::size_t> FollowingGains::parameter_beside(const VectorXd& point) const {
  const std::optional<Index> found = coordinate_beside(point);
  if (!found || *found >= parameters_in(point)) return {};
  return static_cast<std::size_t>(*found);
}

bool FollowingGains::has_slope(std::size_t parameter) const {
  return std::all_of(trials_.begin(), trials_.end(),
                     [&](const Trial& trial) { return trial.slopes[parameter].has_value(); });
}

std::vector<std::vector<Index>> FollowingGains::columns_by_theta(
    const MatrixXd& points, const std::vector<Index>& columns) {
  const Index own = parameters_in(points);
  std::vector<std::vector<Index>> groups;
  for (const Index column : columns) {
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      return points.col(group.front()).head(own) == points.col(column).head(own);
    });
    if (same == groups.end()) {
      groups.push_back({column});
    } else {
      same->push_back(column);
    }
  }
  return groups;
}

std::vector<KalmanGains> FollowingGains::computed(const MatrixXd& points,
                                                  const std::vector<Index>& columns,
                                                  const Dataset& record) const {
  std::vector<NoiseParameters> noise;
  noise.reserve(columns.size());
  for (const Index column : columns)
    noise.push_back(noise_of(points.col(column).tail<kNoiseCoordinates>()));
  const VectorXd theta = points.col(columns.front()).head(parameters_in(points));
  return kalman_gains(linearise(model_, record, parameters_, theta, force_place_), record, noise,
                      data_.noise_floor_m);
}

void FollowingGains::learn(const VectorXd& point, const KalmanGains& gains, Trial& trial) const {
  const std::optional<std::size_t> i = parameter_beside(point);
  const KalmanGains& there = trial.gains;
  // a second mass may come in or go
  if (!i || gains.gains.states != there.gains.states) return;
  const double step = point[static_cast<Index>(*i)] - trial_point_[static_cast<Index>(*i)];
  trial.slopes[*i] = Slope{(gains.gains.gain - there.gains.gain) / step,
                           (gains.gains.scale - there.gains.scale) / step,
                           (gains.log_determinant - there.log_determinant) / step, 0};
}

std::optional<KalmanGains> FollowingGains::followed(const VectorXd& point,
                                                    const Trial& trial) const {
  const std::size_t i = parameter_beside(point).value();
  const double step = point[static_cast<Index>(i)] - trial_point_[static_cast<Index>(i)];
  const Slope& slope = trial.slopes[i].value();
  if (slope.gain.rows() != trial.gains.gains.gain.rows()) return {};
  KalmanGains result = trial.gains;
  result.gains.gain += step * slope.gain;
  result.gains.scale += step * slope.scale;
  result.log_determinant += step * slope.log_determinant;
  return result;
}

}  // namespace estimator::greybox::disturbance
