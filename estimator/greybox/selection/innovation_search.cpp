#include "estimator/greybox/selection/innovation_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <utility>

#include "estimator/greybox/selection/confidence.h"
#include "estimator/greybox/selection/driven_evidence.h"
#include "estimator/greybox/selection/innovation_curves.h"
#include "estimator/greybox/selection/resonance_or_line.h"
#include "estimator/greybox/selection/rig_scale.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {

namespace {

constexpr int kMostExchanges = 2;
/// Share of what a search has explained that may be owed to its models being inexact: a candidate
/// has to gain more. Lines are nearly exact: their frequencies are tuned, what they move simulated.
constexpr double kInexact = 0.005;
constexpr double kInexactLines = 0.0005;
/// Lag of another search's model, settled once, that settling it fully, which gains some tens, does
/// not make up for.
constexpr double kOutOfReach_nats = 200.0;
/// The same share of what interpolating the command has gained.
constexpr double kInterpolated = 0.02;
/// Effects with which a change or a law found early is compared.
constexpr std::size_t kComparedEffects = 2;
/// Fastest speed over the RMS of the motion's.
constexpr double kFastest = 3.0;

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

/// Takes the model that another search holds, where it is more likely than the stage reached.
bool take_held(const SearchContext& context, const ModelStage& held, double evidence_nats,
               InnovationStage& stage, std::vector<InnovationRound>& rounds) {
  if (held.added.empty() || context.cancelled()) return false;
  const SimulationWidth width = wide(context.options.threads);
  InnovationStage other = settled(context, held, stage.noise, Settling::once, width);
  if (!(penalised(other) < penalised(stage) + 2.0 * kOutOfReach_nats)) return false;
  InnovationStage polished = settled(context, other.model, other.noise, Settling::fully, width);
  if (penalised(polished) < penalised(other)) other = std::move(polished);
  if (!(penalised(other) < penalised(stage) - 2.0 * evidence_nats)) return false;
  if (!effect_out_of_range(other).empty()) return false;
  InnovationCandidate candidate;
  // those that are new come last, as in every other round
  const auto is_new = [&](const std::string& effect) {
    return std::find(stage.model.added.begin(), stage.model.added.end(), effect) ==
           stage.model.added.end();
  };
  std::vector<std::string>& added = other.model.added;
  auto first_new = std::stable_partition(added.begin(), added.end(), std::not_fn(is_new));
  if (first_new == added.end()) first_new = added.begin();
  candidate.effect = *first_new;
  candidate.taken_with_it.assign(first_new + 1, added.end());
  candidate.settled = true;
  candidate.penalty_nats =
      kPerParameter_nats * (static_cast<double>(other.model.fitted.parameters.size()) -
                            static_cast<double>(stage.model.fitted.parameters.size()));
  candidate.gain_nats = 0.5 * (penalised(stage) - penalised(other));
  candidate.fitted = other.model.fitted;
  candidate.fitted.jacobian.resize(0, 0);
  rounds.push_back({stage.model, {std::move(candidate)}, true});
  stage = std::move(other);
  return true;
}

/// The final stage without effect `i`.
InnovationStage stage_without(const SearchContext& context, const InnovationSearch& search,
                              const InnovationStage& final, std::size_t i) {
  if (search.without.size() > i) return search.without[i];
  const bool only = final.model.added.size() == 1 && std::isfinite(search.bare.minus_two_log);
  if (only && final.noise.lines.size() == search.bare.noise.lines.size()) return search.bare;
  return not_above(context, without(context, final, final.model.added[i]), search.before);
}

/// Exchanges an effect for a likelier one: false where there is none. What was chosen while lines
/// and other effects were not known may have stood for these and another effect together.
bool exchange(const SearchContext& context, InnovationSearch& search, InnovationStage& stage) {
  const std::size_t effects = stage.model.added.size();
  if (effects + stage.noise.lines.size() < 2) return false;
  // so many that leave physics unexplained stand in for a law, whichever they are
  if (effects >= kStandIn && leaves_physics(stage)) return false;
  const std::vector<std::string> added = stage.model.added;
  for (std::size_t i = 0; i < added.size() && !context.cancelled(); ++i) {
    InnovationStage without = stage_without(context, search, stage, i);
    std::vector<InnovationStage> others = exchanges(context, stage, added[i], without, search.memo);
    add_runners_up(context, stage, added[i], search.rounds, others);
    search.rivals[added[i]] =
        rivals_among(stage, added[i], others, inexact_nats(context, search, stage));
    std::erase_if(others, [](const auto& other) { return !effect_out_of_range(other).empty(); });
    const auto best =
        std::min_element(others.begin(), others.end(),
                         [](const auto& a, const auto& b) { return penalised(a) < penalised(b); });
    if (best == others.end() || !(penalised(*best) < penalised(stage) - 2.0 * kRivals_nats))
      continue;
    InnovationStage polished =
        settled(context, best->model, best->noise, Settling::fully, wide(context.options.threads));
    if (penalised(polished) < penalised(*best)) *best = std::move(polished);
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
      settled(context, stage.model, stage.noise, Settling::fully, wide(context.options.threads));
  if (penalised(polished) < penalised(stage)) stage = std::move(polished);
  return true;
}

/// True where the search ends at the several effects that another one holds.
bool ends_at_held(const SearchContext& context, const ModelStage& held,
                  const InnovationSearch& search, const SearchLimits& limits) {
  if (!limits.ends_at || held.added.size() < 2 || context.cancelled()) return false;
  const InnovationStage stage =
      settled(context, held, search.before.noise, Settling::once, wide(context.options.threads));
  return penalised(stage) < penalised(search.before) &&
         limits.ends_at(stage, inexact_nats(context, search, stage));
}

/// True for so many effects that they may stand in for a law, where they leave much physics: a
/// fourth would hardly be claimed.
bool stand_in_for_law(const InnovationStage& stage, double inexact_nats) {
  return stage.model.added.size() >= kStandIn && leaves_much_physics(stage, inexact_nats);
}

/// Notes the effects whose gains the motion does not show.
void note_undriven(const SearchContext& context, InnovationSearch& search,
                   const InnovationStage& final) {
  for (const std::string& effect : final.model.added) {
    const auto gain = search.gains_nats.find(effect);
    if (gain == search.gains_nats.end() || !std::isfinite(gain->second) || context.cancelled())
      continue;
    if (!is_driven(context, final, effect, gain->second)) search.undriven.insert(effect);
  }
}

void note_gains(InnovationSearch& search, const InnovationStage& final) {
  const std::set<std::string> added(final.model.added.begin(), final.model.added.end());
  for (const InnovationRound& round : search.rounds) {
    if (!round.taken || !added.contains(round.candidates.front().effect)) continue;
    const InnovationCandidate& taken = round.candidates.front();
    if (taken.taken_with_it.empty()) search.gains_nats[taken.effect] = taken.gain_nats;
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
    records.resize(context.problem.data.fitted_records);
    context.problem.data = fit_dataset(std::move(records), {});
    assume_noise_floor(context.problem.data);
  }
  return context;
}

bool is_clearly_likelier(const SearchContext& with_holdouts, const InnovationStage& found,
                         const InnovationStage& stage, const ModelStage& held) {
  const SearchContext context = without_holdouts(with_holdouts);
  const double enough = penalised(found) + 2.0 * kRivals_nats;
  if (!(enough < penalised(stage))) return false;
  std::vector<ModelStage> others;
  if (!held.added.empty()) others.push_back(held);
  if (stage.model.added.empty()) {
    std::vector<InnovationTrial> effects = effect_trials(stage);
    sort_by_gain(effects);
    effects.resize(std::min(effects.size(), kComparedEffects));
    for (InnovationTrial& effect : effects) {
      for (ModelStage& start : effect.starts) others.push_back(std::move(start));
    }
  }
  std::vector<double> costs(others.size());
  in_parallel(others.size(), context.options.threads, [&](std::size_t i) {
    // with the lines that were seen beside what was found
    const InnovationStage once =
        settled(context, std::move(others[i]), found.noise, Settling::once, SimulationWidth{});
    costs[i] = penalised(once);
    if (!(costs[i] < enough + 2.0 * kOutOfReach_nats)) return;
    costs[i] = std::min(costs[i], penalised(settled(context, once.model, once.noise,
                                                    Settling::fully, SimulationWidth{})));
  });
  return !context.cancelled() &&
         std::all_of(costs.begin(), costs.end(), [&](double cost) { return enough < cost; });
}

bool explains_record(const SearchContext& with_holdouts, const InnovationStage& before,
                     const ModelStage& held) {
  if (held.added.empty() || held.added.size() >= kStandIn || with_holdouts.cancelled())
    return false;
  const SearchContext context = without_holdouts(with_holdouts);
  InnovationSearch search;
  search.before = before;
  search.final =
      settled(context, held, before.noise, Settling::once, wide(context.options.threads));
  if (!(penalised(search.final) < penalised(before) - 2.0 * kEvidence_nats) ||
      !effect_out_of_range(search.final).empty()) {
    return false;
  }
  search.inexact_nats = inexact_nats(context, search, search.final);
  weigh_remainder(context, search);
  return !context.cancelled() && !search.physics_missing();
}

InnovationSearch search_innovations(const SearchContext& with_holdouts, const ModelStage& first,
                                    const SearchBranch& held, const SearchLimits& limits) {
  const SearchContext context = without_holdouts(with_holdouts);
  InnovationSearch search;
  search.memo = TrialMemo(held.rounds);
  InnovationStage stage =
      settled(context, first, {}, Settling::fully, wide(context.options.threads));
  search.before = stage;
  if (!std::isfinite(stage.minus_two_log)) return search;  // cancelled before anything was known
  const auto evidence_nats = [&] { return kEvidence_nats + inexact_nats(context, search, stage); };
  std::set<std::string> dropped;
  bool may_go_on_from_held = true;
  bool went_on_from_held = false;
  const auto extend_fully = [&] {
    bool more = true;
    while (more && !search.ended_early && !context.cancelled() &&
           !stand_in_for_law(stage, inexact_nats(context, search, stage))) {
      if (stage.model.added.empty()) search.bare = stage;
      const RoundOptions options{Candidates::effects_and_lines, limits.most_effects,
                                 evidence_nats()};
      more = extend(context, stage, options, search.memo, search.rounds, dropped);
      // skips the rounds that lead to a held model; a single effect is preferred to several
      if (std::exchange(may_go_on_from_held, false) &&
          explains_record(context, search.before, held.stage)) {
        went_on_from_held = take_held(context, held.stage, evidence_nats(), stage, search.rounds);
        more |= went_on_from_held;
      }
      search.ended_early =
          more && limits.ends_at && limits.ends_at(stage, inexact_nats(context, search, stage));
    }
  };
  search.ended_early = ends_at_held(context, held.stage, search, limits);
  extend_fully();
  if (!search.ended_early && take_line_for_resonance(context, search, stage)) extend_fully();
  if (!search.ended_early && !went_on_from_held)
    take_held(context, held.stage, evidence_nats(), stage, search.rounds);
  for (int round = 0; !search.ended_early && !context.cancelled(); ++round) {
    search.without = eliminate(context, stage, search.before, evidence_nats());
    if (round == kMostExchanges || !exchange(context, search, stage)) break;
    extend_fully();
  }
  // at the end, so that it favours no second mass over what is exchanged for it
  const double found = stage.minus_two_log;
  reconsider_second_mass(context, stage);
  if (stage.minus_two_log < found) {
    search.rivals.clear();
    search.without = eliminate(context, stage, search.before, evidence_nats());
  }
  search.inexact_nats = inexact_nats(context, search, stage);
  note_gains(search, stage);
  note_undriven(context, search, stage);
  search.final = std::move(stage);
  weigh_remainder(context, search);
  return search;
}

void add_lines(const SearchContext& context, InnovationSearch& search, InnovationStage& stage) {
  std::set<std::string> none;
  bool more = true;
  while (more && !context.cancelled()) {
    const RoundOptions options{Candidates::lines, 0,
                               kEvidence_nats + inexact_nats(context, search, stage)};
    more = extend(context, stage, options, search.memo, search.rounds, none);
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
                                          const InnovationSearch& search, std::size_t i,
                                          TrialMemo& memo) {
  if (with_holdouts.problem.candidate_effects.empty()) return {};
  const SearchContext context = without_holdouts(with_holdouts);
  InnovationStage without = stage_without(context, search, search.final, i);
  without.context.problem.model = context.problem.model;
  without.context.problem.candidate_effects = context.problem.candidate_effects;
  without.context.problem.trial_sizes = context.problem.trial_sizes;
  return exchanges(context, search.final, search.final.model.added[i], without, memo);
}

std::vector<InnovationRivals> find_rivals(const SearchContext& context,
                                          const InnovationSearch& search,
                                          const std::vector<std::string>& effects) {
  const std::vector<std::string>& added = search.final.model.added;
  std::vector<InnovationRivals> groups;
  TrialMemo memo = search.memo;
  for (std::size_t i = 0; i < added.size() && !context.cancelled(); ++i) {
    if (std::find(effects.begin(), effects.end(), added[i]) == effects.end()) continue;
    const auto known = search.rivals.find(added[i]);
    InnovationRivals group;
    if (known != search.rivals.end()) {
      group = known->second;
    } else {
      std::vector<InnovationStage> others = exchanges_of(context, search, i, memo);
      add_runners_up(without_holdouts(context), search.final, added[i], search.rounds, others);
      group = rivals_among(search.final, added[i], others, search.inexact_nats);
    }
    if (group.names.size() > 1) groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace estimator::greybox::selection
