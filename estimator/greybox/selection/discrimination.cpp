#include "estimator/greybox/selection/discrimination.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/linear_algebra/decompositions.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kDifference = 1e-3;  ///< step of the difference quotients, search units
constexpr double kPart = 0.05;
constexpr int kReweightings = 3;
constexpr int kRivalIterations = 15;
constexpr double kRivalTolerance = 1e-3;

/// Residual and its derivatives at the rival's theta.
MatrixXd with_derivatives(const SearchContext& context, const FitDataset& data,
                          const FitSummary& rival) {
  DatasetSimulation run(context.problem.model, data, rival.parameters);
  const Index count = rival.theta.size();
  MatrixXd points = rival.theta.replicate(1, count + 1);
  for (Index i = 0; i < count; ++i) {
    const auto& parameter = rival.parameters[static_cast<std::size_t>(i)];
    const bool up = rival.theta[i] + kDifference <= parameter.upper;
    points(i, i + 1) += up ? kDifference : -kDifference;
  }
  MatrixXd residuals_m(data.size(), count + 1);
  MatrixXd some_m;
  for (Index from = 0; from <= count; from += ObserverSimulation::kLanes) {
    const Index lanes = std::min<Index>(ObserverSimulation::kLanes, count + 1 - from);
    run.residuals(points.middleCols(from, lanes), some_m);
    residuals_m.middleCols(from, lanes) = some_m;
  }
  for (Index i = 0; i < count; ++i) {
    residuals_m.col(i + 1) =
        (residuals_m.col(i + 1) - residuals_m.col(0)) / (points(i, i + 1) - rival.theta[i]);
  }
  return residuals_m;
}

/// Level that a difference has to exceed: the noise, or a small share of the rival's unexplained
/// error.
double unseen_m(const FitDataset& data, const FitSummary& rival) {
  return std::max(data.noise_floor_m, kPart * rival.validation_rms_m);
}

}  // namespace

double expected_separation(const SearchContext& context, const FitDataset& data,
                           const FitSummary& rival) {
  const MatrixXd columns = with_derivatives(context, data, rival);
  if (!columns.allFinite()) return std::numeric_limits<double>::infinity();
  const Index count = rival.theta.size();
  const MatrixXd weighted = data.all_mask.asDiagonal() * columns;
  const MatrixXd products = weighted.transpose() * weighted;
  const VectorXd counted = data.all_mask;
  const double samples = counted.sum();
  VectorXd left_m = columns.col(0);
  for (int pass = 0; pass < kReweightings; ++pass) {
    const double sigma_m = std::max(data.noise_floor_m, rms(left_m, counted)) *
                           std::sqrt(correlation_factor(left_m, counted));
    const double per_square = 1.0 / (sigma_m * sigma_m);
    MatrixXd normal = per_square * products.bottomRightCorner(count, count);
    VectorXd slope = per_square * products.col(0).tail(count);
    for (Index i = 0; i < count; ++i) {
      const auto& parameter = rival.parameters[static_cast<std::size_t>(i)];
      const double sd = parameter.prior_sd;
      if (std::isfinite(sd)) {
        normal(i, i) += 1.0 / (sd * sd);
        slope[i] += (rival.theta[i] - parameter.prior_mean) / (sd * sd);
      } else {
        normal(i, i) += 1e-9 * normal(i, i) + 1e-12;
      }
    }
    left_m =
        columns.col(0) - columns.rightCols(count) * linear_algebra::solve_symmetric(normal, slope);
  }
  return std::sqrt(left_m.cwiseProduct(counted).squaredNorm() / samples) / unseen_m(data, rival);
}

double fitted_separation(const SearchContext& context, const FitDataset& data,
                         const FitSummary& rival) {
  FitOptions options;
  options.max_iterations = kRivalIterations;
  options.tolerance = kRivalTolerance;
  options.final_jacobian = false;
  options.cancel = context.options.cancel;
  const FitSummary fitted =
      fit(context.problem.model, data, data.training_mask, rival.parameters, rival.theta, options);
  return fitted.validation_rms_m / unseen_m(data, rival);
}

double own_separation(const SearchContext& context, const FitDataset& data,
                      const FitSummary& truth) {
  DatasetSimulation run(context.problem.model, data, truth.parameters);
  MatrixXd residual_m;
  run.residuals(truth.theta, residual_m);
  const double left_m = rms(residual_m.col(0), data.all_mask);
  return std::isfinite(left_m) ? left_m / unseen_m(data, truth)
                               : std::numeric_limits<double>::infinity();
}

}  // namespace estimator::greybox::selection
