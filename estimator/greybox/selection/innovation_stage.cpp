#include "estimator/greybox/selection/innovation_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "estimator/greybox/selection/alternative_refinements.h"
#include "estimator/greybox/selection/innovation_trials.h"
#include "estimator/greybox/selection/likeliest_start.h"
#include "estimator/greybox/selection/revived_refinements.h"
#include "estimator/greybox/selection/settled_memo.h"

namespace estimator::greybox::selection {

namespace {

using Eigen::MatrixXd;

constexpr int kQuickIterations = 10;
constexpr double kQuickTolerance = 2e-4;
constexpr int kTrialIterations = 15;
constexpr double kTrialTolerance = 1e-4;
constexpr int kIterations = 25;
constexpr double kTolerance = 1e-5;
/// Lead in -2 log L that a fit from another start does not make up for after a quick look.
constexpr double kFarBehind = 100.0;
/// Largest lag in -2 log L, and distance from the fit in squared standard errors, at which a quick
/// look from another start has come to the same optimum.
constexpr double kSameOptimum = 1.0;
constexpr double kSameParameters = 4.0;
/// Fall of -2 log L that a refinement brought back has to bring.
constexpr double kRevived = 2.0;
/// ... and each parameter that one has more than the refinement whose place it takes. A shorter one
/// may be as much less likely.
constexpr double kPerRefinement = 6.0;
/// Fall of -2 log L by a step of a trial's noise model below which it is the last.
constexpr double kLastTrialNoiseStep = 1.0;
/// Fall of -2 log L below which another turn of noise model and parameters is of no use.
constexpr double kSettled = 1.0;

/// Starts with a wider and a narrower play: between widths that make contact at other reversals,
/// the likelihood has several maxima.
std::vector<Eigen::VectorXd> resized_plays(const FitSummary& fitted) {
  std::vector<Eigen::VectorXd> starts;
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const FreeParameter& p = fitted.parameters[i];
    if (p.name != disturbance::kPlayWidth) continue;
    const auto at = static_cast<Eigen::Index>(i);
    for (const double ratio : {0.5, 0.7, 1.4, 2.0}) {
      Eigen::VectorXd start = fitted.theta;
      start[at] = std::clamp(p.to_theta(ratio * p.to_physical(start[at])), p.lower, p.upper);
      starts.push_back(std::move(start));
    }
  }
  return starts;
}

SearchContext with_data(const SearchContext& context, FitDataset data) {
  SearchContext result = context;
  result.problem.data = std::move(data);
  return result;
}

/// Distance of other parameters from a fit's in squared standard errors: the rise of -2 log L that
/// its Jacobian expects. Infinite where the fits have other parameters, or no Jacobian is known.
double distance(const FitSummary& fitted, const FitSummary& other, double floor_m) {
  const bool known = fitted.jacobian.cols() == fitted.theta.size();
  if (!known || other.theta.size() != fitted.theta.size())
    return std::numeric_limits<double>::infinity();
  const Eigen::VectorXd by = other.theta - fitted.theta;
  double rise = (fitted.jacobian * by).squaredNorm() / (floor_m * floor_m);
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const double sd = fitted.parameters[i].prior_sd;
    if (std::isfinite(sd)) rise += std::pow(by[static_cast<Eigen::Index>(i)] / sd, 2);
  }
  return rise;
}

/// The stage's data, likelihood and parameters for its noise model. The parameters start where they
/// are and, in a first turn, at other values too.
void refit(const SearchContext& plain, InnovationStage& stage,
           const std::optional<Eigen::VectorXd>& other_start, InnovationFit effort,
           SimulationWidth width) {
  const disturbance::InnovationData data = disturbance::innovation_data(
      plain.problem.model, plain.problem.data, stage.model.fitted.parameters,
      stage.model.fitted.theta, stage.linear, stage.noise);
  stage.context = with_data(plain, data.data);
  const ParameterSubset all = subset(stage.model.fitted, [](const auto&) { return true; });
  FitSummary fitted = fit_innovations(stage.context, all, width, effort);
  const double floor_m = plain.problem.data.noise_floor_m;
  const auto cost = [&](const FitSummary& fit) { return squares(fit, floor_m) + prior_cost(fit); };
  const auto try_other = [&](ParameterSubset start, double enough) {
    FitSummary other = fit_innovations(stage.context, start, width, InnovationFit::quick);
    const double lag = cost(other) - cost(fitted);
    if (lag > kFarBehind) return;
    const bool near = lag >= 0.0 && lag < kSameOptimum && effort == InnovationFit::trial;
    if (near && distance(fitted, other, floor_m) < kSameParameters) return;
    start.start = other.theta;
    other = fit_innovations(stage.context, start, width, effort);
    if (cost(other) + enough < cost(fitted) && !ends_at_least(other)) fitted = std::move(other);
  };
  const auto try_start = [&](Eigen::VectorXd start, double enough) {
    try_other({all.parameters, std::move(start)}, enough);
  };
  if (other_start) {
    try_start(*other_start, 0.0);
    for (const Eigen::VectorXd& start : resized_plays(fitted)) try_start(start, 0.0);
  }
  for (const Eigen::VectorXd& start : revived_refinements(fitted)) try_start(start, kRevived);
  if (other_start && effort == InnovationFit::converged) {
    const ModelStage found{stage.model.added, fitted};
    for (const ParameterSubset& other : alternative_refinements(plain, found)) {
      if (plain.cancelled()) break;
      const double more = static_cast<double>(other.parameters.size()) -
                          static_cast<double>(fitted.parameters.size());
      try_other(other, kPerRefinement * more + kRevived);
    }
  }
  // others that have come in since make it of no use
  if (const ParameterSubset rest = without_least(fitted, stage.model.added);
      effort == InnovationFit::converged && rest.parameters.size() < fitted.parameters.size()) {
    const double fewer = static_cast<double>(fitted.parameters.size() - rest.parameters.size());
    try_other(rest, kRevived - kPerRefinement * fewer);
  }
  stage.model.fitted = std::move(fitted);
  disturbance::update_waves(stage.context.problem.model, stage.context.problem.data,
                            stage.model.fitted.parameters, stage.model.fitted.theta, stage.linear,
                            stage.noise);
  stage.minus_two_log =
      squares(stage.model.fitted, floor_m) + data.log_determinant + prior_cost(stage.model.fitted);
}

}  // namespace

double squares(const FitSummary& fitted, double floor_m) {
  return fitted.residual_m.squaredNorm() / (floor_m * floor_m);
}

FitSummary fit_innovations(const SearchContext& context, const ParameterSubset& parameters,
                           SimulationWidth width, InnovationFit effort) {
  const bool quick = effort == InnovationFit::quick;
  const bool trial = effort == InnovationFit::trial;
  FitOptions options;
  options.max_iterations = quick ? kQuickIterations : trial ? kTrialIterations : kIterations;
  options.tolerance = quick ? kQuickTolerance : trial ? kTrialTolerance : kTolerance;
  options.passes = quick ? 1 : 2;
  options.final_jacobian = !quick;
  options.cancel = context.options.cancel;
  options.width = width;
  return fit(context.problem.model, context.problem.data, context.problem.data.training_mask,
             parameters.parameters, parameters.start, options);
}

namespace {

SettledMemo::Settled settled_anew(const SearchContext& plain, ModelStage model,
                                  const disturbance::NoiseModel& start, int turns,
                                  SimulationWidth width) {
  if (plain.cancelled()) return {};
  InnovationStage stage;
  stage.model = std::move(model);
  stage.noise = start;
  stage.context = plain;
  // a disturbance that was not known may have bent the parameters
  std::optional<Eigen::VectorXd> other = with_file_values(plain, stage.model);
  if (!(start.noise.sensor_m > 0.0)) {
    FitSummary& fitted = stage.model.fitted;
    std::vector<ParameterSubset> starts = {{fitted.parameters, fitted.theta}};
    if (*other != fitted.theta) starts.push_back({fitted.parameters, *other});
    LikeliestStart likeliest = likeliest_start(plain, std::move(starts), start, width.threads);
    stage.noise = std::move(likeliest.noise);
    if (likeliest.start.start != fitted.theta)
      *other = std::exchange(fitted.theta, likeliest.start.start);
  }
  SettledMemo::Settled result;
  InnovationStage& best = result.stage;
  for (int i = 0; i < turns && !plain.cancelled(); ++i) {
    result.turns = i + 1;
    const FitSummary& fitted = stage.model.fitted;
    const auto estimate_noise = [&] {
      stage.noise =
          disturbance::estimate_noise(plain.problem.model, plain.problem.data, fitted.parameters,
                                      fitted.theta, stage.linear, stage.noise, width.threads,
                                      turns > 1 ? disturbance::kLastNoiseStep : kLastTrialNoiseStep)
              .noise;
    };
    stage.linear = disturbance::linearise(plain.problem.model, stage.context.problem.data,
                                          fitted.parameters, fitted.theta, stage.noise.force_place);
    if (i == 0 && disturbance::has_play(plain.problem.model, fitted.parameters, fitted.theta)) {
      estimate_noise();
      const disturbance::InnovationData followed =
          disturbance::innovation_data(plain.problem.model, plain.problem.data, fitted.parameters,
                                       fitted.theta, stage.linear, stage.noise);
      stage.linear = disturbance::linearise(plain.problem.model, followed.data, fitted.parameters,
                                            fitted.theta, stage.noise.force_place);
    }
    estimate_noise();
    refit(plain, stage, other, turns > 1 ? InnovationFit::converged : InnovationFit::trial, width);
    other.reset();
    const double gain = penalised(best) - penalised(stage);
    if (gain > 0.0) best = stage;
    result.converged = gain < kSettled;
    if (result.converged) break;
    if (i + 1 < turns) {
      disturbance::tune_frequencies(stage.context.problem.model, stage.context.problem.data,
                                    stage.model.fitted.parameters, stage.model.fitted.theta,
                                    stage.linear, stage.noise);
    }
  }
  return result;
}

}  // namespace

InnovationStage settled(const SearchContext& plain, ModelStage model,
                        const disturbance::NoiseModel& start, int turns, SimulationWidth width) {
  if (!plain.memo) return settled_anew(plain, std::move(model), start, turns, width).stage;
  const std::string key = SettledMemo::key_of(plain, model, start, width);
  if (std::optional<InnovationStage> known = plain.memo->find(plain, key, turns))
    return *std::move(known);
  SettledMemo::Settled anew = settled_anew(plain, std::move(model), start, turns, width);
  if (!plain.cancelled() && std::isfinite(anew.stage.minus_two_log))
    plain.memo->keep(key, turns, anew);
  return std::move(anew.stage);
}

FitSummary simulated(const SearchContext& context, const FitSummary& fitted) {
  DatasetSimulation run(context.problem.model, context.problem.data, fitted.parameters);
  FitSummary result = fitted;
  result.jacobian.resize(0, 0);
  MatrixXd residual_m;
  run.residuals(fitted.theta, residual_m);
  result.residual_m = residual_m.col(0);
  result.training_rms_m = rms(result.residual_m, context.problem.data.training_mask);
  result.validation_rms_m = rms(result.residual_m, context.problem.data.validation_mask);
  return result;
}

}  // namespace estimator::greybox::selection
