#include "estimator/greybox/selection/first_stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/greybox/dataset_simulation.h"
#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/greybox/selection/innovation_stage.h"
#include "estimator/greybox/selection/parameter_subset.h"

namespace estimator::greybox::selection {
namespace {

/// Error over the noise from which on another minimum may lie below the one that was found.
constexpr double kFar = 3.0;
/// Share of its error that the other minimum leaves at most.
constexpr double kLower = 0.9;

bool has_effects(const DiagnosisProblem& problem) {
  return std::any_of(problem.plant_parameters.begin(), problem.plant_parameters.end(),
                     [](const FreeParameter& p) { return p.name.find('.') != std::string::npos; });
}

}  // namespace

double nominal_rms_m(const SearchContext& context) {
  DatasetSimulation run(context.problem.model, context.problem.data,
                        context.problem.plant_parameters);
  Eigen::MatrixXd residuals_m;
  run.residuals(start_of(context.problem.model, context.problem.plant_parameters), residuals_m);
  return rms(residuals_m.col(0), context.problem.data.validation_mask);
}

ModelStage first_stage(const SearchContext& context) {
  const DiagnosisProblem& problem = context.problem;
  const SimulationWidth width = wide(context.options.threads);
  const auto fitted_from = [&](const Eigen::VectorXd& start) {
    return refit(context, {problem.plant_parameters, start}, problem.data.training_mask, width);
  };
  const Eigen::VectorXd file = start_of(problem.model, problem.plant_parameters);
  ModelStage stage{{}, fitted_from(file)};
  if (!has_effects(problem) || context.cancelled() ||
      !(stage.fitted.validation_rms_m > kFar * problem.data.noise_floor_m)) {
    return stage;
  }
  ModelStage as_given;  // the fit may be stuck
  as_given.fitted.parameters = problem.plant_parameters;
  as_given.fitted.theta = file;
  const InnovationStage likeliest =
      settled(without_holdouts(context), std::move(as_given), {}, Settling::once, width);
  if (!std::isfinite(likeliest.minus_two_log)) return stage;
  FitSummary other = fitted_from(likeliest.model.fitted.theta);
  if (other.training_rms_m < kLower * stage.fitted.training_rms_m) stage.fitted = std::move(other);
  return stage;
}

}  // namespace estimator::greybox::selection
