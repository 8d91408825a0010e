#include "estimator/greybox/selection/innovation_stage.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "estimator/greybox/disturbance/joint_maximum.h"
#include "estimator/greybox/selection/alternative_refinements.h"
#include "estimator/greybox/selection/innovation_trials.h"
#include "estimator/greybox/selection/likeliest_start.h"
#include "estimator/greybox/selection/other_fits.h"
#include "estimator/greybox/selection/revived_refinements.h"
#include "estimator/greybox/selection/settled_memo.h"

namespace estimator::greybox::selection {

namespace {

using Eigen::MatrixXd;

constexpr int kQuickInnovationIterations = 10;
constexpr double kQuickTolerance = 2e-4;
constexpr int kTrialIterations = 15;
constexpr double kTrialTolerance = 1e-4;
constexpr int kIterations = 25;
constexpr double kTolerance = 1e-5;
/// Fall of -2 log L that a refinement brought back has to bring.
constexpr double kRevived = 2.0;
/// Fall of -2 log L by a step of a trial's noise model below which it is the last.
constexpr double kLastTrialNoiseStep = 1.0;
/// Turns of noise model and parameters before the search for both together, which finds the nearest
/// maximum alone.
constexpr int kTurns = 2;
/// Searches for both together, the frequencies of lines tuned between them.
constexpr int kMostJoint = 2;
/// Fall of -2 log L by one search for both from which on another is worth its time.
constexpr double kWorthAnother = 5.0;

/// Starts with a wider and a narrower play: between widths that make contact at other reversals,
/// the likelihood has several maxima. A trial of another effect leaves a play as it was settled.
std::vector<Eigen::VectorXd> resized_plays(const FitSummary& fitted,
                                           const std::vector<std::string>& added,
                                           InnovationFit effort) {
  std::vector<Eigen::VectorXd> starts;
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const FreeParameter& p = fitted.parameters[i];
    if (p.name != disturbance::kPlayWidth) continue;
    if (effort == InnovationFit::trial && !added.empty() && !belongs_to(p, added.back())) continue;
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

void update_waves(InnovationStage& stage) {
  disturbance::update_waves(stage.context.problem.model, stage.context.problem.data,
                            stage.model.fitted.parameters, stage.model.fitted.theta, stage.linear,
                            stage.noise);
}

void tune_frequencies(InnovationStage& stage) {
  disturbance::tune_frequencies(stage.context.problem.model, stage.context.problem.data,
                                stage.model.fitted.parameters, stage.model.fitted.theta,
                                stage.linear, stage.noise);
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
  const auto take_likeliest = [&](const std::vector<OtherStart>& others) {
    fitted = likeliest_fit(stage.context, std::move(fitted), others, effort, width);
  };
  std::vector<OtherStart> others;
  if (other_start) {
    others.push_back({{all.parameters, *other_start}, 0.0});
    for (Eigen::VectorXd& start : resized_plays(fitted, stage.model.added, effort))
      others.push_back({{all.parameters, std::move(start)}, 0.0});
  }
  for (Eigen::VectorXd& start : revived_refinements(plain.problem.model, fitted))
    others.push_back({{all.parameters, std::move(start)}, kRevived});
  take_likeliest(others);
  if (other_start && effort == InnovationFit::converged) {
    others.clear();
    for (ParameterSubset& other : alternative_refinements(plain, {stage.model.added, fitted}))
      others.push_back({std::move(other), kRevived});
    take_likeliest(others);
  }
  // others that have come in since make it of no use
  if (ParameterSubset rest = without_least(fitted, stage.model.added);
      effort == InnovationFit::converged && rest.parameters.size() < fitted.parameters.size()) {
    take_likeliest({{std::move(rest), kRevived}});
  }
  stage.model.fitted = std::move(fitted);
  update_waves(stage);
  take_own_predictor(plain, stage);
}

/// Moves parameters and noise model to where both together are likeliest.
void maximise_jointly(const SearchContext& plain, InnovationStage& stage, unsigned threads) {
  disturbance::JointMaximum found = disturbance::joint_maximum(
      plain.problem.model, stage.context.problem.data, stage.model.fitted.parameters,
      stage.model.fitted.theta, stage.noise, threads, plain.options.cancel);
  if (plain.cancelled()) return;
  InnovationStage moved = stage;
  moved.model.fitted.theta = std::move(found.theta);
  moved.noise = std::move(found.noise);
  take_own_predictor(plain, moved);
  if (!moved.noise.lines.empty()) {
    update_waves(moved);
    take_own_predictor(plain, moved);
  }
  if (!(moved.minus_two_log < stage.minus_two_log)) return;
  // with frozen gains: the innovations are orthogonal to these slopes as to those of other effects
  const ParameterSubset all = subset(moved.model.fitted, [](const auto&) { return true; });
  FitSummary there = fit_innovations(moved.context, all, SimulationWidth{}, InnovationFit::none);
  moved.model.fitted.jacobian = std::move(there.jacobian);
  moved.model.fitted.at_bound = std::move(there.at_bound);
  stage = std::move(moved);
}

}  // namespace

void take_own_predictor(const SearchContext& plain, InnovationStage& stage) {
  FitSummary& fitted = stage.model.fitted;
  const plant_sim::ModelFile& model = plain.problem.model;
  stage.linear = disturbance::linearise(model, stage.context.problem.data, fitted.parameters,
                                        fitted.theta, stage.noise.force_place);
  disturbance::InnovationData own = disturbance::innovation_data(
      model, plain.problem.data, fitted.parameters, fitted.theta, stage.linear, stage.noise);
  stage.context = with_data(plain, std::move(own.data));
  Eigen::MatrixXd jacobian = std::move(fitted.jacobian);
  fitted = simulated(stage.context, fitted);
  fitted.jacobian = std::move(jacobian);
  stage.minus_two_log =
      squares(fitted, plain.problem.data.noise_floor_m) + own.log_determinant + prior_cost(fitted);
}

double squares(const FitSummary& fitted, double floor_m) {
  return fitted.residual_m.squaredNorm() / (floor_m * floor_m);
}

FitSummary fit_innovations(const SearchContext& context, const ParameterSubset& parameters,
                           SimulationWidth width, InnovationFit effort) {
  const bool quick = effort == InnovationFit::quick;
  const bool trial = effort == InnovationFit::trial;
  FitOptions options;
  options.max_iterations = effort == InnovationFit::none ? 0
                           : quick                       ? kQuickInnovationIterations
                           : trial                       ? kTrialIterations
                                                         : kIterations;
  options.tolerance = quick ? kQuickTolerance : trial ? kTrialTolerance : kTolerance;
  options.passes = quick || effort == InnovationFit::none ? 1 : 2;
  options.final_jacobian = !quick;
  options.cancel = context.options.cancel;
  options.width = width;
  return fit(context.problem.model, context.problem.data, context.problem.data.training_mask,
             parameters.parameters, parameters.start, options);
}

namespace {

InnovationStage settled_anew(const SearchContext& plain, ModelStage model,
                             const disturbance::NoiseModel& start, Settling effort,
                             SimulationWidth width) {
  if (plain.cancelled()) return {};
  const bool fully = effort == Settling::fully;
  InnovationStage stage;
  stage.model = std::move(model);
  stage.noise = start;
  stage.context = plain;
  const FitSummary& fitted = stage.model.fitted;
  // a disturbance that was not known may have bent the parameters
  std::optional<Eigen::VectorXd> other = with_file_values(plain, stage.model);
  if (!(start.noise.sensor_m > 0.0)) {
    std::vector<ParameterSubset> starts = {{fitted.parameters, fitted.theta}};
    if (*other != fitted.theta) starts.push_back({fitted.parameters, *other});
    LikeliestStart likeliest = likeliest_start(plain, std::move(starts), start, width.threads);
    stage.noise = std::move(likeliest.noise);
    if (likeliest.start.start != fitted.theta)
      *other = std::exchange(stage.model.fitted.theta, likeliest.start.start);
  }
  const plant_sim::ModelFile& file = plain.problem.model;
  const auto linearise = [&](const FitDataset& data) {
    stage.linear = disturbance::linearise(file, data, fitted.parameters, fitted.theta,
                                          stage.noise.force_place);
  };
  const auto estimate_noise = [&] {
    stage.noise =
        disturbance::estimate_noise(file, plain.problem.data, fitted.parameters, fitted.theta,
                                    stage.linear, stage.noise, width.threads,
                                    fully ? disturbance::kLastNoiseStep : kLastTrialNoiseStep)
            .noise;
  };
  linearise(plain.problem.data);
  if (disturbance::has_play(file, fitted.parameters, fitted.theta)) {
    estimate_noise();
    linearise(disturbance::innovation_data(file, plain.problem.data, fitted.parameters,
                                           fitted.theta, stage.linear, stage.noise)
                  .data);
  }
  InnovationStage best;
  for (int i = 0; i < (fully ? kTurns : 1) && !plain.cancelled(); ++i) {
    if (i > 0) tune_frequencies(stage);
    estimate_noise();
    refit(plain, stage, other, fully ? InnovationFit::converged : InnovationFit::trial, width);
    other.reset();
    if (penalised(stage) < penalised(best)) best = stage;
  }
  for (int i = 0; i < (fully ? kMostJoint : 0) && !plain.cancelled(); ++i) {
    if (i > 0 && !best.noise.lines.empty()) {
      InnovationStage tuned = best;
      tune_frequencies(tuned);
      take_own_predictor(plain, tuned);
      if (tuned.minus_two_log < best.minus_two_log) best = std::move(tuned);
    }
    const double before = best.minus_two_log;
    maximise_jointly(plain, best, width.threads);
    if (!(best.minus_two_log < before - kWorthAnother)) break;
  }
  return best;
}

}  // namespace

InnovationStage settled(const SearchContext& plain, ModelStage model,
                        const disturbance::NoiseModel& start, Settling effort,
                        SimulationWidth width) {
  if (!plain.memo) return settled_anew(plain, std::move(model), start, effort, width);
  const std::string key = SettledMemo::key_of(plain, model, start, effort, width);
  if (std::optional<InnovationStage> known = plain.memo->find(plain, key)) return *std::move(known);
  InnovationStage anew = settled_anew(plain, std::move(model), start, effort, width);
  if (!plain.cancelled() && std::isfinite(anew.minus_two_log)) plain.memo->keep(plain, key, anew);
  return anew;
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
