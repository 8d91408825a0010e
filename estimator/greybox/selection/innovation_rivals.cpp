#include "estimator/greybox/selection/innovation_rivals.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "estimator/greybox/selection/innovation_trials.h"

namespace estimator::greybox::selection {

namespace {

constexpr std::size_t kLargestGroup = 3;
/// Most rivals that get a noise model of their own.
constexpr std::size_t kFinalists = 3;
/// A rival this far behind with the stage's gains may be level with a noise model of its own.
constexpr double kWorthSettling_nats = 60.0;
/// Lag within which a rival with a noise model of its own is polished before it is dismissed, and
/// the share of what the effect gains that it may be more: parameters that another model has bent
/// come back together with the noise model, turn by turn.
constexpr double kWorthPolishing_nats = 30.0;
constexpr double kWorthPolishing = 0.1;

ParameterSubset without_effect(const InnovationStage& stage, const std::string& effect) {
  return subset(stage.model.fitted, [&](const auto& p) { return !belongs_to(p, effect); });
}

/// The stage with other parameters in the place of an effect's, or none.
InnovationStage exchanged(const SearchContext& plain, const InnovationStage& stage,
                          const std::string& effect, const std::string& other,
                          const ParameterSubset& own) {
  ModelStage model;
  for (const std::string& name : stage.model.added) {
    if (name != effect) model.added.push_back(name);
  }
  ParameterSubset parameters = without_effect(stage, effect);
  if (!other.empty()) {
    model.added.push_back(other);
    append(parameters, own);
  }
  model.fitted.parameters = parameters.parameters;
  model.fitted.theta = parameters.start;
  model.fitted =
      fit_innovations(stage.context, parameters, wide(plain.options.threads), InnovationFit::trial);
  return settled(plain, std::move(model), stage.noise, 1, wide(plain.options.threads));
}

}  // namespace

InnovationStage without(const SearchContext& plain, const InnovationStage& stage,
                        const std::string& effect) {
  return exchanged(plain, stage, effect, "", {});
}

std::vector<InnovationStage> eliminate(const SearchContext& plain, InnovationStage& stage,
                                       double evidence_nats) {
  std::vector<InnovationStage> without;
  bool dropped = true;
  while (dropped && stage.model.added.size() > 1 && !plain.cancelled()) {
    dropped = false;
    without.clear();
    for (const std::string& effect : stage.model.added) {
      without.push_back(exchanged(plain, stage, effect, "", {}));
      const double loss = 0.5 * (without.back().minus_two_log - stage.minus_two_log) -
                          penalty_nats(stage.model.fitted, without.back().model.fitted);
      if (loss >= evidence_nats) continue;
      stage = InnovationStage(std::move(without.back()));
      without.clear();
      dropped = true;
      break;
    }
  }
  return without;
}

std::vector<InnovationStage> exchanges(const SearchContext& plain, const InnovationStage& final,
                                       const std::string& effect, const InnovationStage& without) {
  std::vector<InnovationTrial> rivals = effect_trials(without);
  add_simulated_starts(without, simulated_effects(plain, without.model), rivals);
  sort_by_gain(rivals);
  double best = -std::numeric_limits<double>::infinity();
  for (const InnovationTrial& rival : rivals) {
    if (rival.candidate.effect == effect) best = rival.candidate.gain_nats;
  }
  const double worth_polishing_nats =
      kWorthPolishing_nats + kWorthPolishing * 0.5 * (penalised(without) - penalised(final));
  std::vector<InnovationStage> found;
  std::size_t tried = 0;
  for (const InnovationTrial& rival : rivals) {
    const std::string& name = rival.candidate.effect;
    const auto& added = final.model.added;
    if (std::find(added.begin(), added.end(), name) != added.end()) continue;
    const bool far =
        rival.candidate.gain_nats < best - kWorthSettling_nats || rival.candidate.gain_nats < 0.0;
    if ((far && !rival.simulated) || ++tried > kFinalists) continue;
    InnovationStage other = settled(plain, without, rival);
    const double behind_nats = 0.5 * (penalised(other) - penalised(final));
    if (behind_nats >= kRivals_nats && behind_nats < worth_polishing_nats) {
      InnovationStage polished =
          settled(plain, other.model, other.noise, kMostTurns, wide(plain.options.threads));
      if (polished.minus_two_log < other.minus_two_log) other = std::move(polished);
    }
    if (!leaves_its_range(other.model.fitted, without.model.fitted.parameters.size())) {
      found.push_back(std::move(other));
    }
  }
  return found;
}

InnovationRivals rivals_among(const InnovationStage& final, const std::string& effect,
                              const std::vector<InnovationStage>& exchanges) {
  InnovationRivals group{{effect}, {final.model.fitted}};
  for (const InnovationStage& other : exchanges) {
    if (group.names.size() == kLargestGroup) break;
    if (0.5 * (penalised(other) - penalised(final)) >= kRivals_nats) continue;
    group.names.push_back(other.model.added.back());
    group.explanations.push_back(other.model.fitted);
  }
  return group;
}

}  // namespace estimator::greybox::selection
