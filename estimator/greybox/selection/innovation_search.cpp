#include "estimator/greybox/selection/innovation_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "config/schema/joined.h"
#include "estimator/greybox/selection/confidence.h"
#include "estimator/greybox/selection/innovation_curves.h"
#include "estimator/greybox/selection/resonance_or_line.h"
#include "estimator/greybox/selection/rig_scale.h"
#include "estimator/greybox/selection/spectral_line_candidates.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {

namespace {

constexpr std::size_t kMostInnovationEffects = 4;
constexpr std::size_t kMostLines = 4;
constexpr int kMostExchanges = 2;
/// Candidates of a round that get a noise model of their own.
constexpr std::size_t kRoundFinalists = 3;
constexpr std::size_t kMostLineFinalists = 2;
/// Share of what a search has explained that may be owed to its models being inexact: a candidate
/// has to gain more. Lines are nearly exact: their frequencies are tuned, what they move simulated.
constexpr double kInexact = 0.005;
constexpr double kInexactLines = 0.0005;
/// Lead of the likeliest candidate that another may make up for when its noise model and parameters
/// have converged together.
constexpr double kContends_nats = 30.0;
/// Lag of another search's model after one turn of noise model and parameters that further turns,
/// which gain some tens, do not make up for.
constexpr double kOutOfReach_nats = 200.0;
/// The same share of what interpolating the command has gained.
constexpr double kInterpolated = 0.02;
/// Fastest speed over the RMS of the motion's.
constexpr double kFastest = 3.0;

/// Where a line enters is decided before the effects are known that pass it on: the other sites are
/// tried again.
void reconsider_sites(const SearchContext& plain, InnovationStage& stage) {
  for (std::size_t i = 0; i < stage.noise.lines.size(); ++i) {
    for (const disturbance::LineSite site : disturbance::sites_of(stage.linear.front())) {
      if (plain.cancelled() || site == stage.noise.lines[i].site) continue;
      InnovationStage other =
          settled(plain, stage.model, moved(stage.noise, i, site), 1, wide(plain.options.threads));
      if (other.minus_two_log < stage.minus_two_log - 2.0) stage = std::move(other);
    }
  }
}

/// The round of a search by simulations that has begun with the stage's effects, where there is
/// one.
SimulatedEffects simulated_effects(const SearchContext& plain, const InnovationStage& stage,
                                   const SearchBranch& held) {
  for (const Round& round : held.rounds) {
    if (round.before.added == stage.model.added) return simulated_effects(round);
  }
  return simulated_effects(plain, stage.model);
}

/// The first effect of the stage that has left its range, or rings with a line; empty: none.
std::string effect_out_of_range(const InnovationStage& stage) {
  const FitSummary& fitted = stage.model.fitted;
  for (const std::string& effect : stage.model.added) {
    for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
      if (!belongs_to(fitted.parameters[i], effect)) continue;
      if (leaves_its_range(fitted, i, i + 1) ||
          rings_with_a_line(stage, fitted.parameters[i],
                            fitted.theta[static_cast<Eigen::Index>(i)])) {
        return effect;
      }
    }
  }
  return "";
}

/// Drops effects that have left their range since others came in: these, or a law that the library
/// does not have, are what they stood for.
void drop_out_of_range(const SearchContext& plain, InnovationStage& stage,
                       std::vector<std::string>& dropped) {
  for (std::string effect = effect_out_of_range(stage); !effect.empty() && !plain.cancelled();
       effect = effect_out_of_range(stage)) {
    stage = without(plain, stage, effect);
    dropped.push_back(std::move(effect));
  }
}

enum class Candidates { effects_and_lines, lines };

/// One round: false when nothing gains enough. `evidence_nats`: what a candidate must gain.
/// `dropped`: effects that are no candidates any more.
bool extend(const SearchContext& plain, InnovationStage& stage, const SearchBranch& held,
            Candidates candidates, double evidence_nats, std::vector<InnovationRound>& rounds,
            std::vector<std::string>& dropped) {
  std::vector<InnovationTrial> trials;
  const bool effects_too = candidates == Candidates::effects_and_lines;
  if (effects_too && stage.model.added.size() < kMostInnovationEffects) {
    trials = effect_trials(stage);
    add_simulated_starts(stage, simulated_effects(plain, stage, held), trials);
    std::erase_if(trials, [&](const InnovationTrial& trial) {
      return std::find(dropped.begin(), dropped.end(), trial.candidate.effect) != dropped.end();
    });
  }
  if (stage.noise.lines.size() < kMostLines) {
    std::vector<ScoredLine> lines = line_candidates(plain, stage);
    for (std::size_t i = 0; i < std::min(lines.size(), kMostLineFinalists); ++i) {
      InnovationTrial trial;
      trial.candidate.line = lines[i].line;
      trial.penalty_nats = kPerParameter_nats * kParametersOfLine;
      trial.candidate.gain_nats = lines[i].gain_nats - trial.penalty_nats;
      trial.starts = {stage.model};
      trials.push_back(std::move(trial));
    }
  }
  sort_by_gain(trials);
  std::vector<InnovationStage> stages(trials.size());
  SearchProgress progress;
  progress.round = static_cast<int>(rounds.size()) + 1;
  progress.by_innovations = true;
  progress.of = static_cast<int>(trials.size());
  std::mutex reporting;
  in_parallel(trials.size(), plain.options.threads, [&](std::size_t i) {
    InnovationTrial& trial = trials[i];
    const bool finalist = i < kRoundFinalists && trial.candidate.gain_nats > 0.0;
    if (plain.cancelled() || (!finalist && !trial.simulated)) return;
    stages[i] = settled(plain, stage, trial);
    if (!std::isfinite(stages[i].minus_two_log)) return;
    trial.candidate.gain_nats =
        0.5 * (stage.minus_two_log - stages[i].minus_two_log) - trial.penalty_nats;
    trial.candidate.settled = true;
    if (!plain.options.progress) return;
    const std::lock_guard lock(reporting);
    ++progress.done;
    progress.effect = trial.candidate.effect.empty() ? "a spectral line" : trial.candidate.effect;
    plain.options.progress(progress);
  });
  // an effect that leaves its range, at once or with its noise model settled, stands for another
  const std::size_t none = trials.size();
  const std::size_t own = stage.model.fitted.parameters.size();
  const auto likeliest = [&] {
    std::size_t best = none;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      const InnovationCandidate& candidate = trials[i].candidate;
      if (!candidate.settled || !(candidate.gain_nats >= evidence_nats)) continue;
      if (leaves_its_range(stages[i].model.fitted, own)) continue;
      if (best == none || candidate.gain_nats > trials[best].candidate.gain_nats) best = i;
    }
    return best;
  };
  std::vector<char> polished(trials.size(), 0);
  std::size_t chosen = likeliest();
  while (chosen != none && polished[chosen] == 0 && !plain.cancelled()) {
    const double best_nats = trials[chosen].candidate.gain_nats;
    std::vector<std::size_t> contenders;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      const InnovationCandidate& candidate = trials[i].candidate;
      const bool contends = candidate.gain_nats > best_nats - kContends_nats;
      if (contends && candidate.settled && polished[i] == 0) contenders.push_back(i);
    }
    const unsigned threads = plain.options.threads;
    const SimulationWidth width = contenders.size() == 1 ? wide(threads) : SimulationWidth{};
    in_parallel(contenders.size(), threads, [&](std::size_t k) {
      const std::size_t i = contenders[k];
      if (plain.cancelled()) return;
      polished[i] = 1;
      InnovationStage turned = settled(plain, stages[i].model, stages[i].noise, kMostTurns, width);
      if (!(turned.minus_two_log < stages[i].minus_two_log)) return;
      stages[i] = std::move(turned);
      trials[i].candidate.gain_nats =
          0.5 * (stage.minus_two_log - stages[i].minus_two_log) - trials[i].penalty_nats;
    });
    chosen = likeliest();
  }
  for (std::size_t i = 0; i < trials.size(); ++i) {
    trials[i].candidate.penalty_nats = trials[i].penalty_nats;
    if (trials[i].candidate.settled) trials[i].candidate.fitted = stages[i].model.fitted;
    trials[i].candidate.fitted.jacobian.resize(0, 0);
  }
  InnovationRound round{stage.model, {}, chosen != none};
  round.before.fitted.jacobian.resize(0, 0);
  if (chosen != none) round.candidates.push_back(trials[chosen].candidate);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (i != chosen) round.candidates.push_back(trials[i].candidate);
  }
  rounds.push_back(std::move(round));
  if (chosen == none) return false;
  stage = std::move(stages[chosen]);
  if (!effects_too) return true;
  drop_out_of_range(plain, stage, dropped);
  if (!trials[chosen].candidate.effect.empty()) reconsider_sites(plain, stage);
  return true;
}

/// The model that another search holds, where it is more likely than the stage reached.
void take_held(const SearchContext& context, const ModelStage& held, double evidence_nats,
               InnovationStage& stage, std::vector<InnovationRound>& rounds) {
  if (held.added.empty() || context.cancelled()) return;
  const SimulationWidth width = wide(context.options.threads);
  InnovationStage other = settled(context, held, stage.noise, 1, width);
  if (!(penalised(other) < penalised(stage) + 2.0 * kOutOfReach_nats)) return;
  InnovationStage turned = settled(context, other.model, other.noise, kMostTurns, width);
  if (turned.minus_two_log < other.minus_two_log) other = std::move(turned);
  if (!(penalised(other) < penalised(stage) - 2.0 * evidence_nats)) return;
  if (!effect_out_of_range(other).empty()) return;
  InnovationCandidate candidate;
  candidate.effect = config::schema::joined(held.added, "+");
  candidate.settled = true;
  candidate.penalty_nats = 0.5 * (penalised(other) - other.minus_two_log);
  candidate.gain_nats = 0.5 * (penalised(stage) - penalised(other));
  candidate.fitted = other.model.fitted;
  candidate.fitted.jacobian.resize(0, 0);
  rounds.push_back({stage.model, {std::move(candidate)}, true});
  stage = std::move(other);
}

/// The final stage without effect `i`.
InnovationStage stage_without(const SearchContext& context, const InnovationSearch& search,
                              const InnovationStage& final, std::size_t i) {
  if (search.without.size() > i) return search.without[i];
  if (final.model.added.size() + final.noise.lines.size() == 1) return search.before;
  return without(context, final, final.model.added[i]);
}

double largest_curve_nats(const InnovationStage& stage) {
  const std::vector<CurveGain> curves = curve_gains(stage);
  return curves.empty() ? 0.0 : curves.front().gain_nats;
}

/// Exchanges an effect for a likelier one: false where there is none. What was chosen while lines
/// and other effects were not known may have stood for these and another effect together.
bool exchange(const SearchContext& context, InnovationSearch& search, InnovationStage& stage) {
  const std::size_t effects = stage.model.added.size();
  if (effects + stage.noise.lines.size() < 2) return false;
  // so many that leave physics unexplained stand in for a law, whichever they are
  if (effects >= kStandIn && largest_curve_nats(stage) > kCurve_nats) return false;
  const std::vector<std::string> added = stage.model.added;
  for (std::size_t i = 0; i < added.size() && !context.cancelled(); ++i) {
    InnovationStage without = stage_without(context, search, stage, i);
    std::vector<InnovationStage> others = exchanges(context, stage, added[i], without);
    search.rivals[added[i]] = rivals_among(stage, added[i], others);
    std::erase_if(others, [](const auto& other) { return !effect_out_of_range(other).empty(); });
    const auto best =
        std::min_element(others.begin(), others.end(),
                         [](const auto& a, const auto& b) { return penalised(a) < penalised(b); });
    if (best == others.end() || !(penalised(*best) < penalised(stage) - 2.0 * kRivals_nats))
      continue;
    InnovationStage polished =
        settled(context, best->model, best->noise, kMostTurns, wide(context.options.threads));
    if (polished.minus_two_log < best->minus_two_log) *best = std::move(polished);
    InnovationCandidate candidate;
    candidate.effect = best->model.added.back();
    candidate.settled = true;
    candidate.penalty_nats = penalty_nats(best->model.fitted, without.model.fitted);
    candidate.gain_nats = 0.5 * (penalised(without) - penalised(*best));
    stage = std::move(*best);
    candidate.fitted = stage.model.fitted;
    candidate.fitted.jacobian.resize(0, 0);
    without.model.fitted.jacobian.resize(0, 0);
    search.rounds.push_back({std::move(without.model), {std::move(candidate)}, true});
    search.rivals.clear();
    search.without.clear();
    return true;
  }
  return false;
}

/// Puts a spectral line in the place of a resonance that hardly damps, where it explains as much.
bool take_line_for_resonance(const SearchContext& context, InnovationSearch& search,
                             InnovationStage& stage) {
  std::optional<LineInstead> instead = line_for_resonance(context, stage);
  if (!instead) return false;
  instead->without.model.fitted.jacobian.resize(0, 0);
  search.rounds.push_back(
      {std::move(instead->without.model), {std::move(instead->candidate)}, true});
  search.rivals.clear();
  search.without.clear();
  stage = std::move(instead->stage);
  reconsider_sites(context, stage);
  InnovationStage polished =
      settled(context, stage.model, stage.noise, kMostTurns, wide(context.options.threads));
  if (polished.minus_two_log < stage.minus_two_log) stage = std::move(polished);
  return true;
}

/// Nats that the lines of a search have gained, each when it was taken.
double gained_by_lines_nats(const std::vector<InnovationRound>& rounds) {
  double sum_nats = 0.0;
  for (const InnovationRound& round : rounds) {
    if (!round.taken || !round.candidates.front().effect.empty()) continue;
    sum_nats += round.candidates.front().gain_nats + round.candidates.front().penalty_nats;
  }
  return sum_nats;
}

/// Gains that the stage may owe to inexact models of what the search has explained.
double inexact_nats(const SearchContext& context, const InnovationSearch& search,
                    const InnovationStage& stage) {
  const double all_nats = 0.5 * (search.before.minus_two_log - stage.minus_two_log);
  const double lines_nats = gained_by_lines_nats(search.rounds);
  return kInterpolated * context.problem.interpolated_nats +
         kInexact * std::max(0.0, all_nats - lines_nats) + kInexactLines * lines_nats;
}

bool is_among(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void note_gains(InnovationSearch& search, const InnovationStage& final) {
  for (const InnovationRound& round : search.rounds) {
    if (!round.taken || !is_among(final.model.added, round.candidates.front().effect)) continue;
    const InnovationCandidate& taken = round.candidates.front();
    search.gains_nats[taken.effect] = taken.gain_nats;
  }
  for (std::size_t i = 0; i < search.without.size(); ++i) {
    const InnovationStage& without = search.without[i];
    search.gains_nats[final.model.added[i]] =
        0.5 * (without.minus_two_log - final.minus_two_log) -
        penalty_nats(final.model.fitted, without.model.fitted);
  }
}

}  // namespace

SearchContext without_holdouts(SearchContext context) {
  if (context.problem.data.has_holdouts()) {
    std::vector<Dataset>& records = context.problem.data.records;
    const bool interpolated = context.problem.data.command_is_interpolated;
    records.resize(context.problem.data.fitted_records);
    context.problem.data = fit_dataset(std::move(records), {});
    context.problem.data.command_is_interpolated = interpolated;
    assume_noise_floor(context.problem.data);
  }
  return context;
}

InnovationSearch search_innovations(const SearchContext& with_holdouts, const ModelStage& first,
                                    const SearchBranch& held) {
  const SearchContext context = without_holdouts(with_holdouts);
  InnovationSearch search;
  InnovationStage stage = settled(context, first, {}, kMostTurns, wide(context.options.threads));
  search.before = stage;
  if (!std::isfinite(stage.minus_two_log)) return search;  // cancelled before anything was known
  const auto evidence_nats = [&] { return kEvidence_nats + inexact_nats(context, search, stage); };
  std::vector<std::string> dropped;
  const auto extend_fully = [&] {
    while (!context.cancelled() && extend(context, stage, held, Candidates::effects_and_lines,
                                          evidence_nats(), search.rounds, dropped)) {
    }
  };
  extend_fully();
  if (take_line_for_resonance(context, search, stage)) extend_fully();
  take_held(context, held.stage, evidence_nats(), stage, search.rounds);
  for (int round = 0; !context.cancelled(); ++round) {
    search.without = eliminate(context, stage, evidence_nats());
    if (round == kMostExchanges || !exchange(context, search, stage)) break;
    extend_fully();
  }
  search.inexact_nats = inexact_nats(context, search, stage);
  note_gains(search, stage);
  search.final = std::move(stage);
  weigh_remainder(context, search);
  return search;
}

void add_lines(const SearchContext& context, InnovationSearch& search, InnovationStage& stage) {
  std::vector<std::string> none;
  while (!context.cancelled() &&
         extend(context, stage, {}, Candidates::lines,
                kEvidence_nats + inexact_nats(context, search, stage), search.rounds, none)) {
  }
  search.inexact_nats = inexact_nats(context, search, stage);
}

disturbance::ForceJump likeliest_jump(const InnovationStage& stage) {
  const FitDataset& data = stage.context.problem.data;
  disturbance::ForceJump best;
  for (std::size_t i = 0; i < data.records.size(); ++i) {
    const Dataset& record = data.records[i];
    const disturbance::ForceJump jump = disturbance::likeliest_jump(
        stage.linear[i], record, *record.innovations,
        stage.model.fitted.residual_m.segment(static_cast<Eigen::Index>(data.starts[i]),
                                              static_cast<Eigen::Index>(record.size())),
        data.noise_floor_m);
    if (jump.gain_nats > best.gain_nats) best = jump;
  }
  return best;
}

void weigh_remainder(const SearchContext& context, InnovationSearch& search) {
  search.curve_nats = context.cancelled() ? 0.0 : largest_curve_nats(search.final);
  search.jump = likeliest_jump(search.final);
  // a reading that leaps, or that stays where its range ends, asks for any force
  const RigScale rig = rig_scale(context.problem.model, context.problem.data);
  const bool force = !search.final.linear.empty() && search.final.linear.front().force;
  if (std::abs(search.jump.size) > (force ? rig.force_N : kFastest * rig.speed_mps))
    search.jump = {};
}

std::vector<InnovationStage> exchanges_of(const SearchContext& with_holdouts,
                                          const InnovationSearch& search, std::size_t i) {
  if (with_holdouts.problem.candidate_effects.empty()) return {};
  const SearchContext context = without_holdouts(with_holdouts);
  InnovationStage without = stage_without(context, search, search.final, i);
  without.context.problem.model = context.problem.model;
  without.context.problem.candidate_effects = context.problem.candidate_effects;
  return exchanges(context, search.final, search.final.model.added[i], without);
}

std::vector<InnovationRivals> find_rivals(const SearchContext& context,
                                          const InnovationSearch& search) {
  const std::vector<std::string>& added = search.final.model.added;
  std::vector<InnovationRivals> groups;
  for (std::size_t i = 0; i < added.size() && !context.cancelled(); ++i) {
    const auto gain = search.gains_nats.find(added[i]);
    const auto count = static_cast<double>(search.final.model.fitted.residual_m.size());
    if (search.physics_missing() && gain != search.gains_nats.end() &&
        explained_ratio(gain->second, search.curve_nats, count) < kClearOfRemainder) {
      continue;
    }
    const auto known = search.rivals.find(added[i]);
    InnovationRivals group =
        known != search.rivals.end()
            ? known->second
            : rivals_among(search.final, added[i], exchanges_of(context, search, i));
    if (group.names.size() > 1) groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace estimator::greybox::selection
