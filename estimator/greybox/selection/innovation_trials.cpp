#include "estimator/greybox/selection/innovation_trials.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "estimator/greybox/selection/likeliest_start.h"
#include "estimator/greybox/selection/screening_memo.h"
#include "estimator/greybox/sensor_place.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {

namespace {

using disturbance::NoiseModel;
using Eigen::VectorXd;

/// Effects whose linear estimate promises less are not fitted.
constexpr double kHopeless_nats = 4.0;
/// Most effects fitted with the stage's gains.
constexpr std::size_t kFitted = 8;
/// Most effects fitted in a simulation, and of these the most that become starts, when they leave
/// less than this share of the error.
constexpr std::size_t kSimulated = 4;
constexpr std::size_t kSimulatedStarts = 2;
constexpr double kWorthSimulating = 0.97;
constexpr int kTrialStartIterations = 10;
constexpr double kTrialStartTolerance = 2e-3;
constexpr double kSimulationTolerance = 1e-5;

ModelStage with_effect(const ModelStage& stage, const std::string& effect, FitSummary fitted) {
  ModelStage next{stage.added, std::move(fitted)};
  next.added.push_back(effect);
  return next;
}

FitOptions simulation_options(const SearchContext& context, InnovationFit effort) {
  const bool thorough = effort == InnovationFit::converged;
  FitOptions options;
  options.max_iterations = thorough ? FitOptions{}.max_iterations : kTrialStartIterations;
  options.tolerance = thorough ? kSimulationTolerance : kTrialStartTolerance;
  options.final_jacobian = thorough;
  options.cancel = context.options.cancel;
  return options;
}

std::vector<plant_sim::EffectInfo> absent_from(const SearchContext& context,
                                               const ModelStage& model) {
  std::vector<plant_sim::EffectInfo> effects;
  for (const plant_sim::EffectInfo& effect : context.problem.candidate_effects) {
    if (std::find(model.added.begin(), model.added.end(), effect.name) == model.added.end()) {
      effects.push_back(effect);
    }
  }
  return effects;
}

double squares_and_priors(const InnovationStage& stage) {
  const double floor_m = stage.context.problem.data.noise_floor_m;
  return squares(stage.model.fitted, floor_m) + prior_cost(stage.model.fitted);
}

}  // namespace

NoiseModel with_force_on_other_mass(const InnovationStage& stage) {
  NoiseModel noise = stage.noise;
  const bool behind_spring = stage.model.fitted.value(kSecondMassSensorRatio) > 0.5;
  const bool on_second = noise.force_place < 0.0 ? behind_spring : noise.force_place > 0.5;
  noise.force_place = on_second ? 0.0 : 1.0;
  return noise;
}

NoiseModel moved(NoiseModel noise, std::size_t line, disturbance::LineSite site) {
  noise.lines[line].site = site;
  if (line < noise.waves.size()) {
    noise.waves[line].assign(noise.waves[line].size(), Eigen::Vector2d::Zero());
  }
  return noise;
}

double penalty_nats(const FitSummary& with, const FitSummary& without) {
  return kPerParameter_nats *
         static_cast<double>(with.parameters.size() - without.parameters.size());
}

double penalised(const InnovationStage& stage) {
  return stage.minus_two_log +
         2.0 * kPerParameter_nats * static_cast<double>(stage.model.fitted.parameters.size());
}

std::vector<ScreeningResult> screened_effects(const InnovationStage& stage) {
  return screen(stage.context, stage.model, absent_from(stage.context, stage.model));
}

double expected_nats(const InnovationStage& stage, const ScreeningResult& screened) {
  const double ratio = screened.expected_ratio;
  return 0.5 * (1.0 - ratio * ratio) * squares_and_priors(stage);
}

double promised_nats(const InnovationStage& stage) {
  double most_nats = 0.0;
  for (const ScreeningResult& effect : screened_effects(stage)) {
    if (!effect.starts.empty()) most_nats = std::max(most_nats, expected_nats(stage, effect));
  }
  return most_nats;
}

namespace {

/// An effect's key in the memo; empty without one.
std::string definition_of(const SearchContext& context, const std::string& effect) {
  if (!context.screenings) return "";
  const std::vector<plant_sim::EffectInfo>& all = context.problem.candidate_effects;
  const auto info = std::find_if(all.begin(), all.end(),
                                 [&](const auto& candidate) { return candidate.name == effect; });
  assert(info != all.end());
  return ScreeningMemo::key_of(context, *info);
}

bool has_sensor_place(const ParameterSubset& start) {
  return std::any_of(start.parameters.begin(), start.parameters.end(),
                     [](const auto& p) { return p.name == kSecondMassSensorRatio; });
}

/// A resonance as it was screened on either side of the spring, the plant as the stage and as the
/// file have it.
std::vector<std::vector<ParameterSubset>> starts_elsewhere(const InnovationStage& stage,
                                                           const ScreeningResult& screened) {
  std::vector<std::vector<ParameterSubset>> sides;
  for (const ParameterSubset& start : screened.starts) {
    const bool known = std::any_of(sides.begin(), sides.end(), [&](const auto& side) {
      return has_sensor_place(side.front()) == has_sensor_place(start);
    });
    ModelStage at = stage.model;
    at.fitted.parameters = start.parameters;
    at.fitted.theta = start.start;
    std::vector<ParameterSubset> side = mass_share_starts(stage.context, at);
    if (!known && !side.empty()) sides.push_back(std::move(side));
  }
  return sides;
}

}  // namespace

std::vector<InnovationTrial> effect_trials(const InnovationStage& stage) {
  const SearchContext& context = stage.context;
  const double floor_m = context.problem.data.noise_floor_m;
  std::vector<ScreeningResult> screened = screened_effects(stage);
  const double before = squares_and_priors(stage);
  std::erase_if(screened, [&](const ScreeningResult& result) {
    return expected_nats(stage, result) < kHopeless_nats;
  });
  screened.resize(std::min(screened.size(), kFitted));
  struct Start {
    std::size_t effect;
    const ParameterSubset* parameters;
    std::string key;
    FitSummary fitted;
  };
  std::vector<Start> starts;  // all at once: some fits take many times as long as others
  const std::string beside =
      context.screenings ? ScreeningMemo::key_of(context, stage.model) : std::string();
  for (std::size_t i = 0; i < screened.size(); ++i) {
    const std::string effect = beside + definition_of(context, screened[i].effect);
    int number = 0;
    for (const ParameterSubset& one : screened[i].starts)
      starts.push_back({i, &one, effect + std::to_string(number++), {}});
  }
  in_parallel(starts.size(), context.options.threads, [&](std::size_t k) {
    if (context.cancelled()) return;
    starts[k].fitted = known_or<FitSummary>(context, starts[k].key, [&] {
      FitSummary quick =
          fit_innovations(context, *starts[k].parameters, SimulationWidth{}, InnovationFit::quick);
      quick.jacobian.resize(0, 0);
      return quick;
    });
  });
  std::vector<InnovationTrial> trials(screened.size());
  for (std::size_t i = 0; i < screened.size(); ++i) {
    trials[i].candidate.effect = screened[i].effect;
    trials[i].candidate.gain_nats = -std::numeric_limits<double>::infinity();
  }
  for (Start& start : starts) {
    if (start.fitted.parameters.empty()) continue;  // cancelled
    InnovationTrial& trial = trials[start.effect];
    const double penalty = penalty_nats(start.fitted, stage.model.fitted);
    const double gain =
        0.5 * (before - squares(start.fitted, floor_m) - prior_cost(start.fitted)) - penalty;
    if (!(gain > trial.candidate.gain_nats)) continue;
    trial.candidate.gain_nats = gain;
    trial.penalty_nats = penalty;
    trial.starts = {with_effect(stage.model, trial.candidate.effect, std::move(start.fitted))};
  }
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (!trials[i].starts.empty() && expected_nats(stage, screened[i]) >= kEvidence_nats)
      trials[i].elsewhere = starts_elsewhere(stage, screened[i]);
  }
  return trials;
}

namespace {

/// The model, its parameters fitted in a simulation with the weak observer.
ModelStage with_observer(const SearchContext& plain, const ModelStage& model) {
  const ParameterSubset all = subset(model.fitted, [](const auto&) { return true; });
  const std::string key =
      plain.screenings ? ScreeningMemo::key_of_fit(plain, model) : std::string();
  return {model.added, known_or<FitSummary>(plain, key, [&] {
            return fit(plain.problem.model, plain.problem.data, plain.problem.data.training_mask,
                       all.parameters, all.start,
                       simulation_options(plain, InnovationFit::converged));
          })};
}

SimulatedEffects simulated_effects(const SearchContext& plain, const ModelStage& model) {
  const ModelStage base = with_observer(plain, model);
  std::vector<ScreeningResult> screened = screen(plain, base, absent_from(plain, base));
  screened.resize(std::min(screened.size(), kSimulated));
  const std::string beside = plain.screenings ? ScreeningMemo::key_of(plain, base) : std::string();
  SimulatedEffects result;
  result.training_rms_without_m = base.fitted.training_rms_m;
  result.effects.resize(screened.size());
  in_parallel(screened.size(), plain.options.threads, [&](std::size_t i) {
    const std::string& effect = screened[i].effect;
    result.effects[i] = {
        effect, known_or<FitSummary>(plain, beside + definition_of(plain, effect), [&] {
          return refine(plain, screened[i], simulation_options(plain, InnovationFit::quick)).fitted;
        })};
  });
  return result;
}

SimulatedEffects simulated_effects(const Round& round) {
  SimulatedEffects result;
  result.training_rms_without_m = round.before.fitted.training_rms_m;
  for (const Candidate& candidate : round.candidates) {
    if (!candidate.fitted_at_all || candidate.effects.size() > 1) continue;
    result.effects.push_back({candidate.effects.front(), candidate.fitted});
  }
  return result;
}

}  // namespace

std::vector<std::string> parameters_of(const ModelStage& model) {
  std::vector<std::string> names;
  for (const FreeParameter& p : model.fitted.parameters) names.push_back(p.name);
  std::sort(names.begin(), names.end());
  return names;
}

SimulatedEffectsMemo::SimulatedEffectsMemo(const std::vector<Round>& known) {
  for (const Round& round : known)
    known_.emplace(parameters_of(round.before), simulated_effects(round));
}

const SimulatedEffects& SimulatedEffectsMemo::beside(const SearchContext& plain,
                                                     const ModelStage& model) {
  const auto [at, is_new] = known_.try_emplace(parameters_of(model));
  if (is_new) at->second = simulated_effects(plain, model);
  return at->second;
}

bool SimulatedEffectsMemo::knows(const ModelStage& model) const {
  return known_.contains(parameters_of(model));
}

void add_simulated_starts(const InnovationStage& stage, SimulatedEffects simulated,
                          std::vector<InnovationTrial>& trials) {
  std::vector<SimulatedEffect>& effects = simulated.effects;
  std::stable_sort(effects.begin(), effects.end(), [](const auto& a, const auto& b) {
    return a.fitted.training_rms_m < b.fitted.training_rms_m;
  });
  effects.resize(std::min(kSimulatedStarts, effects.size()));
  for (SimulatedEffect& one : effects) {
    if (!(one.fitted.training_rms_m < kWorthSimulating * simulated.training_rms_without_m)) break;
    auto trial = std::find_if(trials.begin(), trials.end(), [&](const InnovationTrial& known) {
      return known.candidate.effect == one.effect;
    });
    if (trial == trials.end()) {
      trials.emplace_back();
      trial = trials.end() - 1;
      trial->candidate.effect = one.effect;
      trial->penalty_nats = penalty_nats(one.fitted, stage.model.fitted);
    }
    trial->starts.push_back(with_effect(stage.model, one.effect, std::move(one.fitted)));
    trial->simulated = true;
  }
}

void sort_by_gain(std::vector<InnovationTrial>& trials) {
  std::stable_sort(trials.begin(), trials.end(),
                   [](const InnovationTrial& a, const InnovationTrial& b) {
                     return a.candidate.gain_nats > b.candidate.gain_nats;
                   });
}

}  // namespace estimator::greybox::selection
