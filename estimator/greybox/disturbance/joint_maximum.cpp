#include "estimator/greybox/disturbance/joint_maximum.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/greybox/fit.h"
#include "estimator/nonlinear/minimize.h"
#include "estimator/parallel.h"

namespace estimator::greybox::disturbance {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kIterations = 12;
constexpr double kTolerance = 1e-5;
/// Difference step of the noise parameters, which are logarithms.
constexpr double kNoiseStep = 1e-2;
constexpr Index kNoise = SearchPoint::RowsAtCompileTime;

/// Innovations of predictors that follow each column of (theta, noise point), each scaled by its
/// own predictor, and a last row
///
///   sqrt(n + log det - log det at the start),   n valid samples
///
/// whose square is the likelihood's second term, and whose slope together with that of the scales
/// makes R'R the expected information of a stationary filter. A point with log det lower by more
/// than n, noise too small by a factor e, is no step that the search takes at once.
class FollowingPredictors {
 public:
  FollowingPredictors(const plant_sim::ModelFile& model, const FitDataset& data,
                      const std::vector<FreeParameter>& parameters, double force_place,
                      unsigned threads)
      : model_(model),
        data_(data),
        parameters_(parameters),
        force_place_(force_place),
        threads_(threads),
        valid_(data.training_mask.sum()) {
    for (const Dataset& record : data.records) runs_.emplace_back(model, record, parameters);
  }

  void start_from(const VectorXd& point) { start_ = log_determinants(point)[0]; }

  void evaluate(const MatrixXd& points, MatrixXd& residuals_m) {
    const VectorXd log_determinant = log_determinants(points);
    residuals_m.resize(data_.size() + 1, points.cols());
    in_parallel(runs_.size(), threads_, [&](std::size_t r) {
      MatrixXd innovations_m;
      runs_[r].innovations(points.topRows(points.rows() - kNoise), gains_[r], innovations_m);
      const MatrixXd& lines = data_.records[r].innovations->lines;
      if (lines.cols() > 0) innovations_m -= lines * (lines.transpose() * innovations_m).eval();
      residuals_m.middleRows(static_cast<Index>(data_.starts[r]), innovations_m.rows()) =
          innovations_m;
    });
    residuals_m.bottomRows(1) =
        (log_determinant.array() - start_ + valid_).sqrt().transpose() * data_.noise_floor_m;
  }

 private:
  /// Also takes the predictors' gains. Points that differ in their noise alone share what is
  /// linearised.
  VectorXd log_determinants(const MatrixXd& points) {
    const Index own = points.rows() - kNoise;
    std::vector<std::vector<Index>> alike;
    for (Index column = 0; column < points.cols(); ++column) {
      const auto same = std::find_if(alike.begin(), alike.end(), [&](const auto& columns) {
        return points.col(columns.front()).head(own) == points.col(column).head(own);
      });
      if (same == alike.end()) {
        alike.push_back({column});
      } else {
        same->push_back(column);
      }
    }
    const std::size_t records = runs_.size();
    gains_.assign(records, std::vector<InnovationGains>(static_cast<std::size_t>(points.cols())));
    MatrixXd each(points.cols(), static_cast<Index>(records));
    in_parallel(records * alike.size(), threads_, [&](std::size_t k) {
      const std::size_t r = k % records;
      const std::vector<Index>& columns = alike[k / records];
      const Dataset& record = data_.records[r];
      std::vector<NoiseParameters> noise;
      noise.reserve(columns.size());
      for (const Index column : columns)
        noise.push_back(noise_of(points.col(column).tail<kNoise>()));
      std::vector<KalmanGains> kalman =
          kalman_gains(linearise(model_, record, parameters_, points.col(columns.front()).head(own),
                                 force_place_),
                       record, noise, data_.noise_floor_m);
      for (std::size_t i = 0; i < columns.size(); ++i) {
        kalman[i].gains.line_m = record.innovations->line_m;
        gains_[r][static_cast<std::size_t>(columns[i])] = std::move(kalman[i].gains);
        each(columns[i], static_cast<Index>(r)) = kalman[i].log_determinant;
      }
    });
    return each.rowwise().sum();
  }

  const plant_sim::ModelFile& model_;
  const FitDataset& data_;
  const std::vector<FreeParameter>& parameters_;
  double force_place_;
  unsigned threads_;
  double valid_;
  std::vector<ObserverSimulation> runs_;
  std::vector<std::vector<InnovationGains>> gains_;  ///< per record and point
  double start_ = 0.0;
};

}  // namespace

JointMaximum joint_maximum(const plant_sim::ModelFile& model, const FitDataset& data,
                           const std::vector<FreeParameter>& parameters, const VectorXd& theta,
                           const NoiseModel& noise, unsigned threads,
                           const std::function<bool()>& cancel) {
  FollowingPredictors predictors(model, data, parameters, noise.force_place, threads);
  VectorXd weights = VectorXd::Ones(data.size() + 1);
  weights.head(data.size()) = data.training_mask;
  nonlinear::Problem problem = problem_of(data, weights, parameters);
  problem.residuals = data.size() + 1;
  problem.sigma = data.noise_floor_m;
  problem.lanes = ObserverSimulation::kLanes;
  const SearchBounds bounds =
      noise_bounds(linearise(model, data, parameters, theta, noise.force_place), data);
  for (Index i = 0; i < kNoise; ++i) {
    nonlinear::Unknown unknown;
    unknown.lower = bounds.lower[i];
    unknown.upper = bounds.upper[i];
    unknown.step = kNoiseStep;
    problem.unknowns.push_back(unknown);
  }
  problem.evaluate = [&](const MatrixXd& points, MatrixXd& residuals_m) {
    predictors.evaluate(points, residuals_m);
  };
  VectorXd start(theta.size() + kNoise);
  start << theta, point_of(noise.noise).cwiseMax(bounds.lower).cwiseMin(bounds.upper);
  predictors.start_from(start);
  nonlinear::MinimizeOptions how;
  how.max_iterations = kIterations;
  how.cost_tolerance = kTolerance;
  how.renew_all = false;
  how.final_jacobian = false;
  how.cancel = cancel;
  const nonlinear::Solution solution = minimize(problem, start, how);

  JointMaximum result;
  result.theta = solution.x.head(theta.size());
  result.noise = noise;
  result.noise.noise = noise_of(solution.x.tail<kNoise>());
  return result;
}

}  // namespace estimator::greybox::disturbance
