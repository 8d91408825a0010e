#include "estimator/greybox/selection/final_parameters.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "estimator/greybox/pressure_scale.h"
#include "estimator/greybox/selection/innovation_jacobian.h"
#include "estimator/greybox/selection/innovation_stage.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/split_scatter.h"
#include "estimator/greybox/selection/step_error.h"
#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {
namespace {

/// Share of the error that the search left, beyond which a free run's parameters are no better.
constexpr double kBends = 1.5;

/// `errors` are those of the search values by the fit's own residual. The scatter between halves of
/// the record and the error of the integration step are added.
void report_parameters(const SearchContext& context, const Eigen::VectorXd& errors,
                       const Eigen::VectorXd& weights, double observer_per_s, Diagnosis& result) {
  const StepError step = step_error(context, result.final, weights, observer_per_s);
  result.step_error_m = step.rms_m;
  const Eigen::VectorXd scatter = split_scatter(context, result.final, weights, observer_per_s);
  for (std::size_t i = 0; i < result.final.parameters.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const FreeParameter& p = result.final.parameters[i];
    const bool at_bound = result.final.at_bound[i] != 0;
    const double whole = std::hypot(errors[k], scatter[k], step.shift[k]);
    const double error = at_bound ? std::nan("") : whole * p.slope(result.final.theta[k]);
    ParameterValue value{p.name, p.to_physical(result.final.theta[k]), error, at_bound};
    value.in_model = p.in_model;
    if (std::isfinite(p.prior_sd) && p.prior_sd > 0.0) {
      value.prior_sds = (result.final.theta[k] - p.prior_mean) / p.prior_sd;
      const double ratio = errors[k] / p.prior_sd;
      if (std::isfinite(ratio)) value.record_share = std::clamp(1.0 - ratio * ratio, 0.0, 1.0);
    }
    result.parameters.push_back(std::move(value));
  }
}

/// The parameters that simulate best without the observer. The minimum of a free run is narrow,
/// with dry friction one of many: it is sought from the fit with the observer, and once more while
/// the observer weakens.
FitSummary fit_free_run(const SearchContext& context, const ParameterSubset& start) {
  const Eigen::VectorXd& weights = context.problem.data.final_weights();
  const SimulationWidth width = wide(context.options.threads);
  FitSummary best = refit(context, start, weights, width, 0.0);
  ParameterSubset weakened = start;
  for (const double share : {0.3, 0.1, 0.03}) {
    weakened.start = refit(context, weakened, weights, width, share * kObserver_per_s).theta;
  }
  FitSummary other = refit(context, weakened, weights, width, 0.0);
  return rms(other.residual_m, weights) < rms(best.residual_m, weights) ? other : best;
}

/// True where a free run has followed a drift by bending the motion: it gives up an effect of the
/// search, or leaves much more under the observer than the search did, or more than the file does.
bool bends_motion(const SearchContext& context, const StructureSearch& search,
                  const FitSummary& run) {
  const FitSummary& searched = search.final.fitted;
  for (const std::string& effect : search.final.added) {
    if (is_idle(run, effect) && !is_idle(searched, effect)) return true;
  }
  return simulated(context, run).validation_rms_m >
         std::min(kBends * searched.validation_rms_m, search.nominal_rms_m);
}

}  // namespace

void fit_final_parameters(const SearchContext& context, Diagnosis& result) {
  const ModelStage& stage = result.search.final;
  const ParameterSubset all = subset(stage.fitted, [](const auto&) { return true; });
  const auto observed = [&] {
    return refit(context, all, context.problem.data.final_weights(), wide(context.options.threads));
  };
  bool with_observer =
      stage.fitted.validation_rms_m <= kUnexplained * context.problem.data.noise_floor_m;
  // what is left of the error is no noise: then the values are those that simulate best
  result.final = context.cancelled() ? stage.fitted
                 : with_observer     ? observed()
                                     : fit_free_run(context, all);
  if (!with_observer && !context.cancelled() &&
      bends_motion(context, result.search, result.final)) {
    result.final = observed();
    with_observer = true;
  }
  drop_idle_refinements(stage.added, result.final);
  wrap_phases(result.final);
  result.better = with_values(context.problem.model, result.final);
  keep_file_where_better(context, result);
  const Eigen::VectorXd& weights = context.problem.data.final_weights();
  const double observer_per_s = with_observer ? kObserver_per_s : 0.0;
  report_parameters(context, std_errors(context.problem.data, weights, result.final), weights,
                    observer_per_s, result);
}

void keep_file_where_better(const SearchContext& context, Diagnosis& result) {
  if (!context.cancelled()) return;
  if (simulated(context, result.final).validation_rms_m > result.search.nominal_rms_m) {
    result.better = context.problem.model;
  }
}

void take_parameters(InnovationStage stage, Diagnosis& result) {
  drop_idle_refinements(stage.model.added, stage.model.fitted);
  const FitDataset& data = stage.context.problem.data;
  result.final = stage.model.fitted;
  wrap_phases(result.final);
  result.better = with_values(stage.context.problem.model, result.final);
  FitSummary own = result.final;
  if (!stage.context.cancelled()) {
    own.jacobian = innovation_jacobian(stage, stage.context.options.threads);
    clear_pressure_scale(stage.context.problem.model, own);  // a disturbance scales with the forces
  }
  report_parameters(stage.context, std_errors(data, data.all_mask, own), data.all_mask,
                    kObserver_per_s, result);
}

}  // namespace estimator::greybox::selection
