#include "estimator/greybox/selection/change_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "estimator/greybox/selection/change_fits.h"
#include "estimator/greybox/selection/change_proposals.h"
#include "estimator/greybox/selection/change_rivals.h"
#include "estimator/greybox/selection/innovation_curves.h"
#include "estimator/greybox/selection/law_search.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

constexpr std::size_t kMostChanges = 2;
/// Gain of a curve over the motion, in those of the best change, from which on laws are sought
/// first.
constexpr double kMotionExplains = 2.0;
/// A change counts together with its effect from this share of the effect's gain on: a curve has a
/// constant of its own.
constexpr double kChangeOfEffect = 0.05;
/// Share of the record at its ends in which a step is none.
constexpr double kEnds = 0.01;
/// Samples about a change within which a load that sets in is the change's: a model that brings the
/// gain before the lag instead of behind it is late by the lag.
constexpr double kEdge_samples = 10.0;
/// Twice the gain over a ramp from which on an exponential that has not settled is no ramp.
constexpr double kNoRamp_nats = 20.0 * kEvidence_nats;
/// Time constant, as a share of the record, below which an exponential may be a step.
constexpr double kSudden = 0.02;
/// Time constants after which an exponential has settled.
constexpr double kSettledAfter = 3.0;

/// The likeliest; the plant's own parameter where an absent effect's is hardly likelier: they are
/// one where the equations are.
std::size_t best_of(const std::vector<ChangeProposal>& proposals,
                    const std::vector<InnovationStage>& stages,
                    const std::vector<std::size_t>& among) {
  const auto cost = [&](std::size_t i) {
    return penalised(stages[i]) + (proposals[i].score.absent ? 2.0 * kEvidence_nats : 0.0);
  };
  return *std::min_element(among.begin(), among.end(),
                           [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });
}

std::size_t best_of(const std::vector<ChangeProposal>& proposals,
                    const std::vector<InnovationStage>& stages) {
  std::vector<std::size_t> all(stages.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return best_of(proposals, stages, all);
}

/// Takes a proposal with its polished stage.
void take(const ChangeProposal& taken, InnovationStage polished_stage,
          std::vector<std::string> rivals, InnovationStage& stage, ChangeSearch& search) {
  ParameterChange change;
  change.parameter = taken.score.parameter.name;
  change.rivals = std::move(rivals);
  InnovationCandidate candidate;
  candidate.effect = name_of(taken.score);
  candidate.settled = true;
  candidate.penalty_nats = penalty_nats(polished_stage.model.fitted, stage.model.fitted);
  candidate.gain_nats = 0.5 * (penalised(stage) - penalised(polished_stage));
  const InnovationStage before = std::move(stage);
  stage = std::move(polished_stage);
  candidate.fitted = stage.model.fitted;
  candidate.fitted.jacobian.resize(0, 0);
  InnovationRound round{before.model, {std::move(candidate)}};
  round.before.fitted.jacobian.resize(0, 0);
  search.innovations.gains_nats[round.candidates.front().effect] =
      round.candidates.front().gain_nats;
  search.innovations.rounds.push_back(std::move(round));
  search.changes.push_back(std::move(change));
  search.context = taken.context;
}

/// True for a step so near an end of the record that hardly anything is left on its other side: the
/// parameter is another throughout.
bool at_an_end(const Dataset& record, const ParameterChange& change) {
  if (change.kind != ChangeKind::step) return false;
  const double margin_s = kEnds * (record.t_s.back() - record.t_s.front());
  return change.at_s < record.t_s.front() + margin_s || change.at_s > record.t_s.back() - margin_s;
}

/// True for an exponential that has not settled at the end of the record.
bool ends_beyond(const Dataset& record, const ChangeProposal& change,
                 const InnovationStage& fitted) {
  if (change.score.kind != ChangeKind::exponential) return false;
  const std::string own = name_of(change.score);
  const double time_constant_s = fitted.model.fitted.value(own + ".time_constant_s");
  const double at_s = fitted.model.fitted.value(own + ".at_s");
  const double begin_s = std::isfinite(at_s) ? at_s : record.t_s.front();
  return kSettledAfter * time_constant_s > record.t_s.back() - begin_s;
}

/// True for an exponential that may be a step: its time constant is below kSudden of the record.
bool is_sudden(const Dataset& record, const ChangeProposal& change, const InnovationStage& fitted) {
  const double time_constant_s =
      fitted.model.fitted.value(name_of(change.score) + ".time_constant_s");
  return time_constant_s < kSudden * (record.t_s.back() - record.t_s.front());
}

/// Polishes the stages `which`.
void polish(const std::vector<std::size_t>& which, const std::vector<ChangeProposal>& proposals,
            unsigned threads, std::vector<InnovationStage>& stages) {
  const SimulationWidth width = which.size() == 1 ? wide(threads) : SimulationWidth{};
  in_parallel(which.size(), threads, [&](std::size_t k) {
    stages[which[k]] = polished(proposals[which[k]], stages[which[k]], width);
  });
}

/// Adds the likeliest change; false when none gains enough.
bool add_change(const SearchContext& plain, const std::vector<ChangeProposal>& starts,
                InnovationStage& stage, ChangeSearch& search,
                std::vector<ChangeScore>& scores_taken) {
  const Dataset& record = plain.problem.data.records.front();
  std::vector<ChangeProposal> proposals;
  if (search.changes.empty()) proposals = starts;
  for (const ChangeScore& score : change_candidates(stage)) {
    proposals.push_back(proposal(search.context, stage, score));
  }
  std::vector<InnovationStage> stages = fit_all(proposals, stage, plain.options.threads);
  if (stages.empty() || plain.cancelled()) return false;
  const auto also = [&](const ChangeScore& score) {
    proposals.push_back(proposal(search.context, stage, score));
    stages.push_back(fitted(proposals.back(), stage, wide(plain.options.threads)));
    return proposals.size() - 1;
  };
  std::size_t chosen = best_of(proposals, stages);
  if (proposals[chosen].score.kind == ChangeKind::step) {
    const std::size_t ramp =
        also(ramp_about(proposals[chosen].score, stages[chosen].model.fitted, record));
    // a ramp finds the time of a step from farther away
    also(step_within(proposals[ramp].score, stages[ramp].model.fitted));
    chosen = best_of(proposals, stages);
  }
  if (std::isfinite(
          stages[chosen].model.fitted.value(name_of(proposals[chosen].score) + ".ramp_s"))) {
    const std::size_t settling =
        also(settling_from(proposals[chosen].score, stages[chosen].model.fitted));
    // where it has not settled, the end value is a guess, to be stated only for want of a ramp
    const bool settled = !ends_beyond(record, proposals[settling], stages[settling]);
    if (settled || penalised(stages[settling]) < penalised(stages[chosen]) - kNoRamp_nats) {
      chosen = best_of(proposals, stages);
    } else {
      proposals.pop_back();
      stages.pop_back();
    }
  }
  if (ends_beyond(record, proposals[chosen], stages[chosen])) {
    // the record does not reach its end, which is no value to state
    const std::size_t ramp =
        also(ramp_throughout(proposals[chosen].score, stages[chosen].model.fitted, record));
    const double most = std::min(penalised(stages[chosen]) + 2.0 * kEvidence_nats,
                                 penalised(stage) - 2.0 * kEvidence_nats);
    if (penalised(stages[ramp]) < most) chosen = ramp;
  }
  if (!(penalised(stages[chosen]) < penalised(stage) - 2.0 * kEvidence_nats)) return false;
  if (is_sudden(record, proposals[chosen], stages[chosen])) {
    // its time is near enough now for a step to be found
    polish({chosen}, proposals, plain.options.threads, stages);
    const std::size_t step =
        also(step_within(proposals[chosen].score, stages[chosen].model.fitted));
    polish({step}, proposals, plain.options.threads, stages);
    if (penalised(stages[step]) < penalised(stages[chosen]) + 2.0 * kRivals_nats) chosen = step;
  }
  // what explained much by a course of its own may be a rival by the chosen one
  for (const std::size_t i : contenders(proposals, stages, chosen, penalised(stage))) {
    also(with_course_of(proposals[chosen].score, stages[chosen].model.fitted, proposals[i].score));
  }
  const std::vector<std::string> before = rivals_of(proposals, stages, chosen);
  std::vector<std::size_t> near = nearly_as_likely(proposals, stages, chosen, penalised(stage));
  polish(near, proposals, plain.options.threads, stages);
  chosen = best_of(proposals, stages, near);
  if (ends_beyond(record, proposals[chosen], stages[chosen])) {
    near.push_back(
        also(ramp_throughout(proposals[chosen].score, stages[chosen].model.fitted, record)));
    polish({near.back()}, proposals, plain.options.threads, stages);
    const double most = penalised(stages[chosen]) + 2.0 * kEvidence_nats;
    if (penalised(stages[near.back()]) < most) chosen = near.back();
  }
  std::vector<std::string> rivals = polished_rivals_of(proposals, stages, near, chosen, before);
  take(proposals[chosen], std::move(stages[chosen]), std::move(rivals), stage, search);
  scores_taken.push_back(proposals[chosen].score);
  return true;
}

/// True where the likeliest load sets in with a change, or where its ramp ends.
bool jump_is_a_change(const ChangeSearch& search) {
  const double at_s = search.innovations.jump.time_s;
  const double edge_s = kEdge_samples * search.context.problem.data.sample_time_s;
  return std::any_of(
      search.changes.begin(), search.changes.end(), [&](const ParameterChange& change) {
        const double end_s =
            change.kind == ChangeKind::ramp ? change.at_s + change.duration_s : change.at_s;
        return std::abs(at_s - change.at_s) < edge_s || std::abs(at_s - end_s) < edge_s;
      });
}

/// The search with the changes of a stage described, the lines that are seen beside them, and what
/// remains.
ChangeSearch concluded(ChangeSearch search, InnovationStage stage,
                       const std::vector<ChangeScore>& taken) {
  add_lines(search.context, search.innovations, stage);
  const FitSummary& fitted = stage.model.fitted;
  const FitDataset& data = stage.context.problem.data;
  const Eigen::VectorXd errors = std_errors(data, data.all_mask, fitted);
  for (std::size_t i = 0; i < taken.size(); ++i) {
    std::vector<std::string> rivals = std::move(search.changes[i].rivals);
    search.changes[i] = described(taken[i], fitted, errors);
    const double profile_s = time_error_s(stage, name_of(taken[i]));
    double& at_error_s = search.changes[i].at_error_s;
    // where nothing moves a fit has no curvature
    at_error_s = std::isinf(at_error_s) ? profile_s : std::max(at_error_s, profile_s);
    search.changes[i].rivals = std::move(rivals);
  }
  search.innovations.final = std::move(stage);
  weigh_remainder(search.context, search.innovations);
  if (jump_is_a_change(search)) search.innovations.jump = {};
  return search;
}

/// The last of two changes without the first, which may have stood for it while it was not known;
/// none where that is clearly less likely than both.
std::optional<ChangeSearch> last_alone(ChangeSearch search, InnovationStage stage,
                                       const std::vector<ChangeScore>& taken,
                                       const ChangeSearch& both) {
  const ChangeProposal last = proposal(search.context, stage, taken.back());
  const InnovationStage alone = fitted(last, stage, wide(search.context.options.threads));
  if (!std::isfinite(alone.minus_two_log)) return {};
  take(last, polished(last, alone, wide(search.context.options.threads)),
       both.changes.back().rivals, stage, search);
  ChangeSearch found = concluded(std::move(search), std::move(stage), {taken.back()});
  const double enough_nats = kEvidence_nats + both.innovations.inexact_nats;
  if (!(penalised(found.innovations.final) <
        penalised(both.innovations.final) + 2.0 * enough_nats)) {
    return {};
  }
  return found;
}

/// Held-out error of a simulation with the changes.
double validation_rms_m(const ChangeSearch& search) {
  return simulated(search.context, search.innovations.final.model.fitted).validation_rms_m;
}

/// True where a simulation with the changes leaves clearly less than one with the others: the
/// likelihood may gain in a pause of the motion, where nothing is learned of the model.
bool simulates_better(const ChangeSearch& changes, const ChangeSearch& others) {
  return validation_rms_m(changes) < (1.0 - kRivals) * validation_rms_m(others);
}

/// True where no change can be stated beside those found: nothing of the motion is left, and no
/// simulation is clearly better.
bool is_complete(const ChangeSearch& search) {
  return !search.innovations.physics_missing() &&
         (1.0 - kRivals) * validation_rms_m(search) <= search.context.problem.data.noise_floor_m;
}

/// The changes found from a stage on. A second one has to be worth it beside the lines that the
/// first one leaves.
FoundChanges changes_from(ChangeSearch search, const std::vector<ChangeProposal>& starts,
                          InnovationStage stage) {
  const SearchContext plain = search.context;
  const ChangeSearch begun = search;
  const InnovationStage first = stage;
  FoundChanges result;
  std::optional<ChangeSearch> best;
  std::vector<ChangeScore> taken;
  while (taken.size() < kMostChanges && !(best && is_complete(*best)) &&
         add_change(plain, starts, stage, search, taken)) {
    ChangeSearch found = concluded(search, stage, taken);
    const auto cost = [](const ChangeSearch& one) { return penalised(one.innovations.final); };
    const double enough_nats = kEvidence_nats + found.innovations.inexact_nats;
    if (!result.likeliest) result.likeliest = found;
    if (best && !(cost(found) < cost(*best) - 2.0 * enough_nats)) break;
    if (best && !best->innovations.physics_missing() &&
        !(is_clear_of_errors(found.changes.back()) && simulates_better(found, *best))) {
      break;
    }
    best = std::move(found);
  }
  if (!best || plain.cancelled()) return {};
  if (best->changes.size() > 1) {
    const std::optional<ChangeSearch> one = last_alone(begun, first, taken, *best);
    if (one && (!one->innovations.physics_missing() || best->innovations.physics_missing())) {
      best = one;
    }
  }
  const Dataset& record = plain.problem.data.records.front();
  const bool dated =
      std::none_of(best->changes.begin(), best->changes.end(),
                   [&](const ParameterChange& change) { return at_an_end(record, change); });
  if (dated && !best->innovations.physics_missing()) result.explaining = std::move(best);
  return result;
}

/// The context with the laws whose sizes may change.
SearchContext with_changing_laws(const SearchContext& context, const std::vector<Law>& laws) {
  SearchContext result = with_laws(context, laws, names_of(context.problem.candidate_effects));
  result.problem.trial_sizes = context.problem.trial_sizes;
  for (const Law& law : laws) result.problem.shown_by_change.push_back(law.effect.name);
  return result;
}

/// Takes the laws back that are not in the model found.
void drop_unused(const std::vector<Law>& laws, std::optional<ChangeSearch>& found) {
  if (!found) return;
  DiagnosisProblem& problem = found->context.problem;
  const auto is_law = [&](const std::string& name) {
    return std::any_of(laws.begin(), laws.end(),
                       [&](const Law& law) { return law.effect.name == name; });
  };
  const auto is_used = [&](const std::string& name) {
    return std::any_of(found->changes.begin(), found->changes.end(), [&](const auto& change) {
      return change.parameter.starts_with(name + ".");
    });
  };
  std::erase_if(problem.candidate_effects,
                [&](const plant_sim::EffectInfo& effect) { return is_law(effect.name); });
  const auto is_unused = [&](const auto& one) { return is_law(one.name) && !is_used(one.name); };
  std::erase_if(problem.model.formula_effects, is_unused);
  std::erase_if(problem.model.effects, is_unused);
}

/// Gain of the changes when they were taken, before lines were seen beside them.
double gained_nats(const ChangeSearch& search) {
  double sum_nats = 0.0;
  for (const auto& [name, gain_nats] : search.innovations.gains_nats) sum_nats += gain_nats;
  return sum_nats;
}

}  // namespace

double change_nats(const InnovationStage& stage) {
  double most_nats = likeliest_jump(stage).gain_nats;
  for (const ChangeScore& score : change_scores(stage)) {
    const bool both = score.gain_nats > kChangeOfEffect * score.throughout_nats;
    most_nats = std::max(most_nats, score.gain_nats + (both ? score.throughout_nats : 0.0));
  }
  return most_nats;
}

bool motion_explains_more(const InnovationStage& stage) {
  const double best_change = std::max(kEvidence_nats, change_nats(stage));
  for (const CurveGain& curve : curve_gains(stage)) {
    if (curve.variable != "time" && curve.gain_nats > kMotionExplains * best_change) return true;
  }
  return false;
}

namespace {

/// The changes in a model that has the laws whose sizes may change.
FoundChanges search_with_laws(const SearchContext& context, const ModelStage& base,
                              ChangesSought sought, const std::vector<ChangeProposal>& starts) {
  ChangeSearch search{context, {}, {}};
  InnovationStage stage =
      settled(context, base, {}, Settling::fully, wide(context.options.threads));
  if (!std::isfinite(stage.minus_two_log)) return {};
  if (starts.empty() && motion_explains_more(stage) != (sought == ChangesSought::after_laws))
    return {};
  search.innovations.before = stage;
  FoundChanges found = changes_from(search, starts, stage);
  if (found.explaining) return found;
  // a drift passes for a slow line, so that changes are sought without lines first; a strong line
  // hides a change, so that they are sought again behind lines
  add_lines(context, search.innovations, stage);
  if (stage.noise.lines.empty()) return found;
  const double by_lines_nats = 0.5 * (penalised(search.innovations.before) - penalised(stage));
  if (found.likeliest && by_lines_nats < gained_nats(*found.likeliest)) return found;
  FoundChanges behind_lines = changes_from(std::move(search), starts, std::move(stage));
  return behind_lines.likeliest ? behind_lines : found;
}

}  // namespace

FoundChanges search_changes(const SearchContext& context, const ModelStage& base,
                            ChangesSought sought, const std::vector<ChangeProposal>& starts) {
  if (context.problem.data.records.size() != 1 || context.cancelled()) return {};
  const std::vector<Law> laws = changing_laws(context.problem.model, context.problem.data);
  FoundChanges found = search_with_laws(with_changing_laws(context, laws), base, sought, starts);
  drop_unused(laws, found.explaining);
  drop_unused(laws, found.likeliest);
  return found;
}

}  // namespace estimator::greybox::selection
