#include "estimator/greybox/disturbance/joint_maximum.h"

#include <span>
#include <utility>

#include "estimator/greybox/disturbance/following_gains.h"
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
                      const std::vector<FreeParameter>& parameters,
                      const std::vector<nonlinear::Unknown>& unknowns, double force_place,
                      unsigned threads)
      : data_(data),
        following_(model, data, parameters, unknowns, force_place, threads),
        threads_(threads),
        valid_(data.training_mask.sum()) {
    for (const Dataset& record : data.records) runs_.emplace_back(model, record, parameters);
  }

  void start_from(const VectorXd& point) { start_ = log_determinants(point)[0]; }

  void evaluate(const MatrixXd& points, MatrixXd& residuals_m) {
    const VectorXd log_determinant = log_determinants(points);
    residuals_m.resize(data_.size() + 1, points.cols());
    in_parallel(runs_.size(), threads_, [&](std::size_t r) {
      MatrixXd innovations_m = innovations(points.topRows(points.rows() - kNoiseCoordinates), r);
      const MatrixXd& lines = data_.records[r].innovations->lines;
      if (lines.cols() > 0) innovations_m -= lines * (lines.transpose() * innovations_m).eval();
      residuals_m.middleRows(static_cast<Index>(data_.starts[r]), innovations_m.rows()) =
          innovations_m;
    });
    residuals_m.bottomRows(1) =
        (log_determinant.array() - start_ + valid_).sqrt().transpose() * data_.noise_floor_m;
  }

 private:
  /// Neighbouring points whose gains correct the same states run side by side: a second mass may
  /// come in or go.
  [[nodiscard]] MatrixXd innovations(const MatrixXd& theta, std::size_t r) {
    const std::vector<InnovationGains>& gains = gains_[r];
    MatrixXd result(static_cast<Index>(data_.records[r].size()), theta.cols());
    for (std::size_t from = 0; from < gains.size();) {
      std::size_t to = from + 1;
      while (to < gains.size() && gains[to].states == gains[from].states) ++to;
      const auto first = static_cast<Index>(from);
      const auto count = static_cast<Index>(to - from);
      MatrixXd part;
      runs_[r].innovations(theta.middleCols(first, count),
                           std::span(gains).subspan(from, to - from), part);
      result.middleCols(first, count) = part;
      from = to;
    }
    return result;
  }

  /// Also takes the predictors' gains.
  VectorXd log_determinants(const MatrixXd& points) {
    std::vector<std::vector<KalmanGains>> found = following_.at(points);
    gains_.assign(runs_.size(), {});
    VectorXd sum = VectorXd::Zero(points.cols());
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      for (std::size_t i = 0; i < found[r].size(); ++i) {
        found[r][i].gains.line_m = data_.records[r].innovations->line_m;
        gains_[r].push_back(std::move(found[r][i].gains));
        sum[static_cast<Index>(i)] += found[r][i].log_determinant;
      }
    }
    return sum;
  }

  const FitDataset& data_;
  FollowingGains following_;
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
  VectorXd weights = VectorXd::Ones(data.size() + 1);
  weights.head(data.size()) = data.training_mask;
  nonlinear::Problem problem = problem_of(data, weights, parameters);
  problem.residuals = data.size() + 1;
  problem.sigma = data.noise_floor_m;
  problem.lanes = ObserverSimulation::kLanes;
  const SearchBounds bounds =
      noise_bounds(linearise(model, data, parameters, theta, noise.force_place), data);
  for (Index i = 0; i < kNoiseCoordinates; ++i) {
    nonlinear::Unknown unknown;
    unknown.lower = bounds.lower[i];
    unknown.upper = bounds.upper[i];
    unknown.step = kNoiseStep;
    problem.unknowns.push_back(unknown);
  }
  FollowingPredictors predictors(model, data, parameters, problem.unknowns, noise.force_place,
                                 threads);
  problem.evaluate = [&](const MatrixXd& points, MatrixXd& residuals_m) {
    predictors.evaluate(points, residuals_m);
  };
  VectorXd start(theta.size() + kNoiseCoordinates);
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
  result.noise.noise = noise_of(solution.x.tail<kNoiseCoordinates>());
  return result;
}

}  // namespace estimator::greybox::disturbance
