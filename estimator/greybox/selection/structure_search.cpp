#include "estimator/greybox/selection/structure_search.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "estimator/greybox/selection/alternative_refinements.h"
#include "estimator/greybox/selection/backward_elimination.h"
#include "estimator/greybox/selection/candidate_gain.h"
#include "estimator/greybox/selection/command_lead.h"
#include "estimator/greybox/selection/completed_candidates.h"
#include "estimator/greybox/selection/confidence.h"
#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/innovation_trials.h"
#include "estimator/greybox/selection/joined_waves.h"
#include "estimator/greybox/selection/pair_search.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/search_round.h"
#include "estimator/greybox/selection/selection_path.h"
#include "estimator/greybox/selection/substitution.h"

namespace estimator::greybox::selection {
namespace {

constexpr std::size_t kMostEffects = 4;
/// Number of effects added one by one before pairs are tried on an unexplained record.
constexpr std::size_t kBeforePairSearch = 2;
/// Effects of the first round that are tried as alternative starts when the best leads nowhere.
constexpr std::size_t kAlternativeStarts = 3;
/// Largest remaining error ratio of an alternative start. Two effects together may resemble a third
/// one, which then ranks far before either; the start must differ from the best in kind.
constexpr double kHelpful = 0.7;
/// Remaining error over the noise above which alternative starts are tried.
constexpr double kLost = 2.0;
constexpr double kSamePath = 0.1;
/// Remaining error over the noise up to which several effects may hide behind one another. What
/// lies farther is no effect of the library: further effects are added as long as they help, no
/// more.
constexpr double kNearFloor = 5.0;
/// Share of the error of two effects, taken one after another, or of none, that a pair leaves which
/// is taken in their place though a disturbance keeps it from the noise.
constexpr double kPairLeaves = 0.25;

/// Takes the round's first candidate, or one as good with fewer parameters; false when it is no
/// gain.
bool take(const SearchContext& context, const Round& round, ModelStage& stage) {
  if (!is_gain(context, stage, round.candidates.front())) return false;
  stage = completed(context, stage, simplest(context, round.candidates));
  return true;
}

/// Puts the best pair of a round's candidates first where it is a gain and no single one is.
void try_pairs(const SearchContext& context, const ModelStage& stage, Round& round) {
  if (is_gain(context, stage, round.candidates.front()) || is_explained(context, stage) ||
      context.cancelled()) {
    return;
  }
  const std::vector<Candidate> pairs = pair_round(context, round);
  if (!pairs.empty() && is_gain(context, stage, pairs.front())) {
    round.candidates.insert(round.candidates.begin(), pairs.front());
  }
}

/// Refits `before` from the parameters of `after`; none unless it leaves as little without what
/// came in: it had not converged, and any effect would have helped it on.
std::optional<ModelStage> converged_without(const SearchContext& context, const ModelStage& before,
                                            const ModelStage& after) {
  const double gained_m = after.fitted.validation_rms_m;
  if (!(gained_m < (1.0 - kRivals) * before.fitted.validation_rms_m)) return {};
  const ParameterSubset own = subset(after.fitted, [&](const FreeParameter& p) {
    return std::none_of(after.added.begin() + static_cast<std::ptrdiff_t>(before.added.size()),
                        after.added.end(),
                        [&](const std::string& effect) { return belongs_to(p, effect); });
  });
  FitSummary fitted = refit_if_hopeful(context, own, gained_m, wide(context.options.threads));
  const double left_m = fitted.validation_rms_m;
  if (!(left_m < (1.0 + kRivals) * gained_m) ||
      !(left_m < (1.0 - kRivals) * before.fitted.validation_rms_m)) {
    return {};
  }
  return ModelStage{before.added, std::move(fitted)};
}

/// Rounds until the branch has `most` effects, or has converged to what explains the record; false
/// when nothing helps any more, or when the linear estimate of none leaves less than `within_m`.
bool extend_branch(const SearchContext& context, SearchBranch& branch, bool pairs_too,
                   std::size_t most = kMostEffects,
                   double within_m = std::numeric_limits<double>::infinity()) {
  while (branch.stage.added.size() < most && !context.cancelled()) {
    Round round =
        single_round(context, branch.stage, static_cast<int>(branch.rounds.size()) + 1, within_m);
    if (round.candidates.empty()) return false;
    // candidates that cannot be taken go last
    std::stable_partition(
        round.candidates.begin(), round.candidates.end(),
        [&](const Candidate& candidate) { return is_gain(context, branch.stage, candidate); });
    if (pairs_too) try_pairs(context, branch.stage, round);
    branch.stalled = !take(context, round, branch.stage);
    if (!branch.stalled && !round.before.added.empty() && !context.cancelled()) {
      if (std::optional<ModelStage> base = converged_without(context, round.before, branch.stage)) {
        branch.stage = std::move(*base);
        if (is_explained(context, branch.stage)) return true;
        continue;
      }
    }
    branch.rounds.push_back(std::move(round));
    if (branch.stalled) return false;
  }
  return true;
}

/// A candidate as the beginning of a search from `first`, after the round `begun`.
SearchBranch branch_from(const SearchContext& context, const ModelStage& first,
                         const Candidate& candidate, const Round& begun) {
  SearchBranch other{with(first, candidate), {begun}};
  refit_without_refinements(context, other.stage);
  take_alternative_refinements(context, other.stage);
  if (candidate.effects.size() > 1) {
    auto& candidates = other.rounds.front().candidates;
    candidates.insert(candidates.begin(), candidate);
  }
  return other;
}

/// Searches on from a beginning, without pairs.
void complete_branch(const SearchContext& context, CrossValidation& halves, SearchBranch& branch) {
  extend_branch(context, branch, false);
  eliminate_backward(context, halves, branch.stage, EliminationPass::intermediate);
}

bool improves_on(const SearchBranch& other, const SearchBranch& best) {
  return other.stage.fitted.validation_rms_m < (1.0 - kRivals) * best.stage.fitted.validation_rms_m;
}

/// Pair of effects as the beginning, where a stepwise search has not explained the record and the
/// pair leaves at most `most_m`.
std::optional<SearchBranch> start_with_pair(
    const SearchContext& context, const ModelStage& first, const SearchBranch& best,
    double most_m = std::numeric_limits<double>::infinity()) {
  if (best.rounds.empty() || is_explained(context, best.stage) || context.cancelled()) return {};
  std::vector<std::string> begun;  // beginning with which the second round has tried all others
  if (best.rounds.size() > 1) begun = best.rounds[1].before.added;
  const std::vector<Candidate> pairs = pair_search(context, first, begun);
  if (pairs.empty() || !is_gain(context, first, pairs.front())) return {};
  if (!(pairs.front().validation_rms_m <= most_m)) return {};
  return branch_from(context, first, pairs.front(), best.rounds.front());
}

/// The rest of a stepwise search, with pairs where these lead further.
SearchBranch search_forward(const SearchContext& context, CrossValidation& halves,
                            const ModelStage& first, SearchBranch best) {
  if (best.stalled) {
    try_pairs(context, best.stage, best.rounds.back());
    best.stalled = !take(context, best.rounds.back(), best.stage);
    if (!best.stalled) extend_branch(context, best, true, kBeforePairSearch);
  }
  const bool may_go_on = !best.stalled && best.stage.added.size() >= kBeforePairSearch;
  std::optional<SearchBranch> other = start_with_pair(context, first, best);
  if (other) complete_branch(context, halves, *other);
  if (other && is_explained(context, other->stage) && improves_on(*other, best)) return *other;
  if (may_go_on) extend_branch(context, best, true);
  eliminate_backward(context, halves, best.stage, EliminationPass::intermediate);
  return other && improves_on(*other, best) ? *other : best;
}

/// Searches from the next best effects of the first round.
void try_alternative_starts(const SearchContext& context, CrossValidation& halves,
                            const ModelStage& first, SearchBranch& best) {
  if (best.rounds.empty()) return;
  const std::vector<Candidate> firsts = best.rounds.front().candidates;
  for (std::size_t i = 1; i < std::min(kAlternativeStarts, firsts.size()); ++i) {
    if (best.stage.fitted.validation_rms_m < kLost * context.problem.data.noise_floor_m ||
        context.cancelled() || !is_gain(context, first, firsts[i]) ||
        firsts[i].validation_rms_m > kHelpful * first.fitted.validation_rms_m) {
      break;
    }
    const double apart_m = rms(firsts[i].fitted.residual_m - firsts.front().fitted.residual_m,
                               context.problem.data.all_mask);
    if (apart_m < kSamePath * firsts[i].validation_rms_m) continue;
    const auto& added = best.stage.added;
    if (std::find(added.begin(), added.end(), firsts[i].effects.front()) != added.end()) continue;
    SearchBranch other = branch_from(context, first, firsts[i], best.rounds.front());
    complete_branch(context, halves, other);
    if (improves_on(other, best)) best = std::move(other);
  }
}

/// True when a set of effects holds in either half of the records though its parts one after
/// another do not: two that make up for each other are worth nothing alone.
bool set_is_supported(const SearchContext& context, CrossValidation& halves,
                      const ModelStage& first, const ModelStage& set, const ModelStage& parts) {
  const auto all = [](const ModelStage& stage) {
    return subset(stage.fitted, [](const auto&) { return true; });
  };
  return set.added.size() < kStandIn && parts.added.size() < set.added.size() &&
         !context.cancelled() &&
         parts.fitted.validation_rms_m > (1.0 + kRivals) * set.fitted.validation_rms_m &&
         halves.holds(false, all(first), all(set));
}

}  // namespace

const char* to_string(Refusal why) {
  switch (why) {
    case Refusal::unsupported:
      return "unsupported";
    case Refusal::dispensable:
      return "dispensable";
    case Refusal::unlikely:
      break;
  }
  return "unlikely";
}

SearchStart fit_as_given(const SearchContext& context) {
  const auto begin = std::chrono::steady_clock::now();
  SearchStart start;
  start.nominal_rms_m = nominal_rms_m(context);
  start.first = first_stage(context);
  start.preview_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  start.branch.stage = start.first;
  return start;
}

SearchStart start_search(const SearchContext& context) {
  SearchStart start = fit_as_given(context);
  begin_rounds(context, start);
  return start;
}

void begin_rounds(const SearchContext& context, SearchStart& start) {
  if (extend_branch(context, start.branch, false, 1)) {
    complete_rivals(context, start.branch);
    // simulations know nothing of a disturbance: beside one, the likelihood has to find the second
    extend_branch(context, start.branch, false, kBeforePairSearch,
                  kNearFloor * context.problem.data.noise_floor_m);
  }
  if (!start.branch.rounds.empty()) start.preview_s += start.branch.rounds.front().screening_s;
}

void add_effects(const SearchContext& context, SearchBranch& branch, std::size_t most) {
  extend_branch(context, branch, false, most);
}

void add_second_effect(const SearchContext& context, SearchStart& start) {
  if (!start.branch.stalled) extend_branch(context, start.branch, false, kBeforePairSearch);
}

void prefer_pair(const SearchContext& context, SearchStart& start) {
  const double far_less_m = kPairLeaves * start.branch.stage.fitted.validation_rms_m;
  std::optional<SearchBranch> pair =
      start_with_pair(context, start.first, start.branch,
                      std::max(kNearFloor * context.problem.data.noise_floor_m, far_less_m));
  if (!pair) return;
  if (is_explained(context, pair->stage)) {
    CrossValidation halves(context);
    complete_branch(context, halves, *pair);
  } else if (!(pair->stage.fitted.validation_rms_m < far_less_m)) {
    return;
  }
  start.branch = std::move(*pair);
}

StructureSearch abandon_search(const SearchContext& context, const SearchStart& start) {
  StructureSearch search;
  search.nominal_rms_m = start.nominal_rms_m;
  search.preview_s = start.preview_s;
  search.path = {start.first};
  search.final = start.first;
  search.interrupted = context.cancelled();
  return search;
}

void extend_search(const SearchContext& context, SearchStart& start) {
  CrossValidation halves(context);
  add_second_effect(context, start);
  if (start.branch.stage.fitted.validation_rms_m >
      kNearFloor * context.problem.data.noise_floor_m) {
    if (start.branch.stalled) return;
    extend_branch(context, start.branch, false);
    eliminate_backward(context, halves, start.branch.stage, EliminationPass::intermediate);
    return;
  }
  start.branch = search_forward(context, halves, start.first, std::move(start.branch));
  try_alternative_starts(context, halves, start.first, start.branch);
  substitute_idle_effects(context, start.branch);
  join_waves(context, start.branch.stage);
}

void refuse(const ModelStage& stage, Refusal why, const ModelStage& taken,
            StructureSearch& search) {
  if (stage.added == taken.added ||
      !(stage.fitted.validation_rms_m < (1.0 - kWorthTelling) * taken.fitted.validation_rms_m)) {
    return;
  }
  search.refused.push_back({stage.added, stage.fitted.validation_rms_m, why});
}

namespace {

/// Ends a path at its first stage that noise explains and that the last one does not improve on: an
/// effect may have been taken before the others, or the model's own parameters, had converged.
void end_where_explained(const SearchContext& context, std::vector<ModelStage>& path) {
  const ModelStage& last = path.back();
  const auto improved = [&](const ModelStage& stage) {
    Candidate rest;
    rest.effects.assign(last.added.begin() + static_cast<std::ptrdiff_t>(stage.added.size()),
                        last.added.end());
    rest.fitted = last.fitted;
    rest.validation_rms_m = last.fitted.validation_rms_m;
    rest.p_value = chance(context, stage.fitted, last.fitted);
    rest.fitted_at_all = true;
    return is_gain(context, stage, rest);
  };
  const auto end = std::find_if(path.begin(), path.end() - 1, [&](const ModelStage& stage) {
    return is_explained(context, stage) && !improved(stage);
  });
  path.erase(end == path.end() - 1 ? path.end() : end + 1, path.end());
}

}  // namespace

StructureSearch conclude_search(const SearchContext& context, SearchStart start) {
  CrossValidation halves(context);
  StructureSearch search;
  search.nominal_rms_m = start.nominal_rms_m;
  search.preview_s = start.preview_s;
  const ModelStage first = std::move(start.first);
  SearchBranch best = std::move(start.branch);
  const ModelStage& stage = best.stage;
  search.rounds = std::move(best.rounds);
  search.path = path_to(context, first, stage);
  if (!is_explained(context, stage)) {
    std::vector<ModelStage> validated = cross_validated_path(context, halves, search.path);
    if (set_is_supported(context, halves, first, stage, validated.back())) validated = search.path;
    // interrupted: keeps what was found
    if (!context.cancelled()) {
      ModelStage last = validated.back();
      refuse(stage, Refusal::unsupported, last, search);
      eliminate_backward(context, halves, last, EliminationPass::final);
      refuse(validated.back(), Refusal::dispensable, last, search);
      const bool dropped = last.added.size() < validated.back().added.size();
      search.path = dropped ? path_to(context, first, last) : std::move(validated);
      if (!dropped) search.path.back() = std::move(last);
    }
  } else {
    end_where_explained(context, search.path);
  }
  search.final = search.path.back();
  search.interrupted = context.cancelled();
  return search;
}

StructureSearch complete_search(const SearchContext& context, SearchStart start) {
  extend_search(context, start);
  return conclude_search(context, std::move(start));
}

}  // namespace estimator::greybox::selection
