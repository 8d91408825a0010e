#include "estimator/greybox/selection/innovation_rivals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "estimator/greybox/selection/innovation_curves.h"
#include "estimator/greybox/selection/innovation_trials.h"
#include "estimator/greybox/selection/settled_trials.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {

namespace {

constexpr std::size_t kLargestRivalGroup = 3;
/// Most rivals that get a noise model of their own.
constexpr std::size_t kRivalFinalists = 3;
/// A rival this far behind with the stage's gains may be level with a noise model of its own.
constexpr double kWorthSettling_nats = 60.0;
/// Share of the taken effect's gain that another of its round has gained to be tried again.
constexpr double kRunnerUp = 0.5;
/// Share of what the effect gains by which the lag of a rival that is polished may be more:
/// parameters that another model has bent come back together with the noise model, turn by turn.
constexpr double kWorthPolishing = 0.1;

ParameterSubset without_effect(const InnovationStage& stage, const std::string& effect) {
  return subset(stage.model.fitted, [&](const auto& p) { return !belongs_to(p, effect); });
}

/// The stage's model with other parameters, not fitted, in the place of an effect's, or none.
ModelStage in_place_of(const InnovationStage& stage, const std::string& effect,
                       const std::string& other, const ParameterSubset& own) {
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
  return model;
}

/// The model of in_place_of(), fitted and settled.
InnovationStage exchanged(const SearchContext& plain, const InnovationStage& stage,
                          const std::string& effect, const std::string& other,
                          const ParameterSubset& own) {
  ModelStage model = in_place_of(stage, effect, other, own);
  const SimulationWidth width = wide(plain.options.threads);
  model.fitted = fit_innovations(stage.context, {model.fitted.parameters, model.fitted.theta},
                                 width, InnovationFit::trial);
  return settled(plain, std::move(model), stage.noise, Settling::once, width);
}

}  // namespace

InnovationStage without(const SearchContext& plain, const InnovationStage& stage,
                        const std::string& effect) {
  return exchanged(plain, stage, effect, "", {});
}

InnovationStage not_above(const SearchContext& plain, InnovationStage stage,
                          const InnovationStage& bare) {
  if (plain.cancelled() || !(bare.minus_two_log < stage.minus_two_log)) return stage;
  disturbance::NoiseModel noise = bare.noise;
  noise.lines = stage.noise.lines;
  noise.waves = stage.noise.waves;
  const ModelStage strayed = stage.model;
  // the plant as the bare model has it, the effects as they are and absent
  for (const double share : {1.0, 0.0}) {
    ModelStage model = strayed;
    take_values(bare.model.fitted, model.fitted, share);
    InnovationStage again =
        settled(plain, std::move(model), noise, Settling::once, wide(plain.options.threads));
    if (again.minus_two_log < stage.minus_two_log) stage = std::move(again);
  }
  return stage;
}

std::vector<InnovationStage> eliminate(const SearchContext& plain, InnovationStage& stage,
                                       const InnovationStage& bare, double evidence_nats) {
  std::vector<InnovationStage> without;
  bool dropped = true;
  while (dropped && stage.model.added.size() > 1 && !plain.cancelled()) {
    dropped = false;
    without.clear();
    for (const std::string& effect : stage.model.added) {
      without.push_back(not_above(plain, exchanged(plain, stage, effect, "", {}), bare));
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
                                       const std::string& effect, const InnovationStage& without,
                                       TrialMemo& memo) {
  std::vector<InnovationTrial> rivals = memo.effects_beside(without);
  // simulations cost more than they find where the search has needed none so far, and no line has
  // come in since that hid an effect from the stage's gains
  if (!memo.simulated.empty() || !final.noise.lines.empty() || leaves_physics(final))
    add_simulated_starts(without, memo.simulated.beside(plain, without.model), rivals);
  sort_by_gain(rivals);
  // what a predictor without a resonance gains says nothing about one
  std::stable_partition(rivals.begin(), rivals.end(),
                        [](const InnovationTrial& rival) { return !rival.elsewhere.empty(); });
  double best = -std::numeric_limits<double>::infinity();
  for (const InnovationTrial& rival : rivals) {
    if (rival.candidate.effect == effect) best = rival.candidate.gain_nats;
  }
  const double worth_polishing_nats =
      kWorthPolishing_nats + kWorthPolishing * 0.5 * (penalised(without) - penalised(final));
  const std::vector<std::string>& added = final.model.added;
  std::erase_if(rivals, [&](const InnovationTrial& rival) {
    const bool far =
        rival.candidate.gain_nats < best - kWorthSettling_nats || rival.candidate.gain_nats < 0.0;
    return (far && !rival.simulated && rival.elsewhere.empty()) ||
           std::find(added.begin(), added.end(), rival.candidate.effect) != added.end();
  });
  rivals.resize(std::min(rivals.size(), kRivalFinalists));
  std::vector<InnovationStage> found =
      settle_trials(plain, without, rivals, {}, final.minus_two_log);
  const unsigned threads = plain.options.threads;
  const SimulationWidth width = rivals.size() == 1 ? wide(threads) : SimulationWidth{};
  in_parallel(rivals.size(), threads, [&](std::size_t i) {
    const double behind_nats = 0.5 * (penalised(found[i]) - penalised(final));
    if (!(behind_nats >= kRivals_nats && behind_nats < worth_polishing_nats)) return;
    InnovationStage polished =
        settled(plain, found[i].model, found[i].noise, Settling::fully, width);
    if (penalised(polished) < penalised(found[i])) found[i] = std::move(polished);
  });
  std::erase_if(found, [&](const InnovationStage& other) {
    return !std::isfinite(other.minus_two_log) ||
           leaves_its_range(other.model.fitted, without.model.fitted.parameters.size());
  });
  return found;
}

namespace {

/// The likelier of two: the plant as it is in the final stage, which the effect may have bent, and
/// as it was beside the other one.
InnovationStage runner_up(const SearchContext& plain, const InnovationStage& final,
                          const std::string& effect, const InnovationCandidate& other) {
  const auto own = [&](const FreeParameter& p) { return belongs_to(p, other.effect); };
  const ModelStage here = in_place_of(final, effect, other.effect, subset(other.fitted, own));
  ModelStage there = here;
  take_values(other.fitted, there.fitted);
  std::array<const ModelStage*, 2> starts{&here, &there};
  std::array<InnovationStage, 2> reached;
  in_parallel(starts.size(), plain.options.threads, [&](std::size_t i) {
    reached[i] = settled(plain, *starts[i], final.noise, Settling::once, SimulationWidth{});
  });
  const bool is_here = penalised(reached[0]) <= penalised(reached[1]);
  return std::move(is_here ? reached[0] : reached[1]);
}

}  // namespace

void add_runners_up(const SearchContext& plain, const InnovationStage& final,
                    const std::string& effect, const std::vector<InnovationRound>& rounds,
                    std::vector<InnovationStage>& exchanges) {
  const auto taken = std::find_if(rounds.rbegin(), rounds.rend(), [&](const auto& round) {
    return round.taken && round.candidates.front().effect == effect;
  });
  if (taken == rounds.rend()) return;
  const std::vector<std::string>& added = final.model.added;
  const auto is_tried = [&](const std::string& other) {
    return std::find(added.begin(), added.end(), other) != added.end() ||
           std::any_of(exchanges.begin(), exchanges.end(), [&](const InnovationStage& stage) {
             return stage.model.added.back() == other;
           });
  };
  const SimulationWidth width = wide(plain.options.threads);
  for (const InnovationCandidate& other : taken->candidates) {
    if (!other.settled || other.effect.empty() || plain.cancelled() || is_tried(other.effect) ||
        other.gain_nats < kRunnerUp * taken->candidates.front().gain_nats) {
      continue;
    }
    InnovationStage stage = runner_up(plain, final, effect, other);
    if (penalised(stage) < penalised(final) + 2.0 * kWorthSettling_nats) {
      InnovationStage polished = settled(plain, stage.model, stage.noise, Settling::fully, width);
      if (penalised(polished) < penalised(stage)) stage = std::move(polished);
    }
    if (std::isfinite(stage.minus_two_log) && effect_out_of_range(stage).empty())
      exchanges.push_back(std::move(stage));
  }
}

InnovationRivals rivals_among(const InnovationStage& final, const std::string& effect,
                              const std::vector<InnovationStage>& exchanges, double inexact_nats) {
  const double close_nats = kRivals_nats + inexact_nats;
  InnovationRivals group{{effect}, {final.model.fitted}};
  for (const InnovationStage& other : exchanges) {
    if (group.names.size() == kLargestRivalGroup) break;
    if (0.5 * (penalised(other) - penalised(final)) >= close_nats) continue;
    group.names.push_back(other.model.added.back());
    group.explanations.push_back(other.model.fitted);
  }
  return group;
}

}  // namespace estimator::greybox::selection
