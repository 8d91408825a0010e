#include "estimator/greybox/selection/other_file_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "estimator/greybox/dataset_simulation.h"
#include "estimator/greybox/pressure_scale.h"
#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/file_values.h"
#include "estimator/greybox/selection/innovation_trials.h"
#include "estimator/greybox/selection/long_records.h"

namespace estimator::greybox::selection {
namespace {

/// Ranges in those of the priors, 3 standard deviations.
constexpr double kWidest = 4.0;
/// Logarithms of the scales of pressures and forces that are tried, from 0.74 to 1.35.
constexpr double kScaleStep = 0.025;
constexpr int kScaleSteps = 12;
/// Most fits one after another, and the share of the error that the next one is worth.
constexpr int kMostFits = 12;
constexpr double kGoesOn = 0.99;
/// Standard deviations from which on a file's value costs no more than in proportion: sheets and
/// gauges are wrong by far more often than a normal distribution says.
constexpr double kFarOff_sds = 3.0;

/// The errors, squared over the noise, and what the file's values cost.
double cost_of(const SearchContext& context, const FitSummary& fitted) {
  double cost = squares(fitted, context.problem.data.noise_floor_m);
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const FreeParameter& p = fitted.parameters[i];
    if (!std::isfinite(p.prior_sd) || !(p.prior_sd > 0.0)) continue;
    const double off_sds =
        std::abs(fitted.theta[static_cast<Eigen::Index>(i)] - p.prior_mean) / p.prior_sd;
    const double near_sds = std::min(off_sds, kFarOff_sds);
    cost += near_sds * (2.0 * off_sds - near_sds);
  }
  return cost;
}

/// The plant's values of one of the fits at the scale of its pressures and forces that leaves the
/// least: one pressure that is held makes fits end in other minima along the scale.
Eigen::VectorXd likeliest_scale(const SearchContext& context, const std::vector<FitSummary>& fits) {
  const std::vector<FreeParameter>& plant = context.problem.plant_parameters;
  const auto count = static_cast<Eigen::Index>(plant.size());
  const bool scales = std::any_of(plant.begin(), plant.end(), [](const FreeParameter& p) {
    return pressure_scale_power(p.name) != 0.0;
  });
  if (!scales) return fits.front().theta.head(count);
  Eigen::MatrixXd points(count, 0);
  for (const FitSummary& from : fits) {
    for (int step = -kScaleSteps; step <= kScaleSteps; ++step) {
      Eigen::VectorXd point = from.theta.head(count);
      for (Eigen::Index i = 0; i < count; ++i) {
        const FreeParameter& p = plant[static_cast<std::size_t>(i)];
        if (p.scale == ParameterScale::logarithmic)
          point[i] += pressure_scale_power(p.name) * kScaleStep * step;
        point[i] = std::clamp(point[i], p.lower, p.upper);
      }
      points.conservativeResize(Eigen::NoChange, points.cols() + 1);
      points.rightCols(1) = point;
    }
  }
  DatasetSimulation run(context.problem.model, context.problem.data, plant);
  Eigen::VectorXd best = points.col(0);
  double least_m = std::numeric_limits<double>::infinity();
  Eigen::MatrixXd residuals_m;
  for (Eigen::Index from = 0; from < points.cols(); from += ObserverSimulation::kLanes) {
    const Eigen::Index lanes =
        std::min<Eigen::Index>(ObserverSimulation::kLanes, points.cols() - from);
    run.residuals(points.middleCols(from, lanes), residuals_m);
    for (Eigen::Index i = 0; i < lanes; ++i) {
      const double left_m = rms(residuals_m.col(i), context.problem.data.training_mask);
      if (!(left_m < least_m)) continue;
      least_m = left_m;
      best = points.col(from + i);
    }
  }
  return best;
}

}  // namespace

bool prefer_other_file_values(const SearchContext& search, SearchStart& start,
                              DiagnosisProblem& problem) {
  const ModelStage& held = start.branch.stage;
  if (held.added.empty() || !is_explained(search, held) || search.cancelled()) return false;
  DiagnosisProblem widened = problem;
  widen_all(kWidest, widened);
  const SearchContext wider = for_search({widened, search.options, search.memo, search.screenings});
  ModelStage without{{}, start.first.fitted};
  without.fitted.parameters = widened.plant_parameters;
  without.fitted.theta = likeliest_scale(wider, {start.first.fitted, held.fitted});
  // the way along the scale is long and bent
  for (int turn = 0; turn < kMostFits && !is_explained(wider, without); ++turn) {
    const double before_m =
        turn == 0 ? std::numeric_limits<double>::infinity() : without.fitted.training_rms_m;
    without.fitted = refit_to_convergence(wider, without.fitted);
    if (!(without.fitted.training_rms_m < kGoesOn * before_m)) break;
  }
  if (!is_explained(wider, without)) return false;
  const auto more =
      static_cast<double>(held.fitted.parameters.size() - without.fitted.parameters.size());
  const double enough_nats = kEvidence_nats + kPerParameter_nats * more;
  if (!(cost_of(wider, without.fitted) < cost_of(search, held.fitted) + 2.0 * enough_nats))
    return false;
  start.first = without;
  start.branch = {std::move(without), {}, false};
  problem = std::move(widened);
  return true;
}

}  // namespace estimator::greybox::selection
