#include "estimator/greybox/selection/simulated_laws.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "estimator/greybox/selection/backward_elimination.h"
#include "estimator/greybox/selection/change_search.h"
#include "estimator/greybox/selection/conclusion.h"
#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/innovation_curves.h"
#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/greybox/selection/law_search.h"
#include "estimator/greybox/selection/learned_laws.h"
#include "estimator/greybox/selection/search_round.h"
#include "estimator/greybox/selection/spectral_line_candidates.h"

namespace estimator::greybox::selection {
namespace {

/// Most laws beside which a second law or an effect is sought, and most that are held against those
/// that explain the record.
constexpr std::size_t kBeginnings = 3;
constexpr std::size_t kRivalLaws = 4;
/// Effects of the first round beside which a law is sought, and the ratio to the best one's error
/// up to which they may leave.
constexpr std::size_t kNamed = 2;
constexpr double kNearBest = 2.0;
/// Gain of a curve from which on laws are worth their fits.
constexpr double kMuchMotion_nats = 5.0 * kCurve_nats;

/// True where a parameter of the plant, or an effect, ends at its bound: it makes up for what is
/// missing.
bool makes_up(const ModelStage& held, std::size_t plant_parameters) {
  return !held.added.empty() && (ends_at_bound(held.fitted, plant_parameters) ||
                                 leaves_its_range(held.fitted, plant_parameters));
}

/// True where a curve over the motion gains far more than a disturbance that bends a fit lets it,
/// and more than a spectral line: beside either no simulation comes near the noise, and the fits of
/// all laws are in vain. What changes in time may look like a law too.
bool leaves_much_motion(const SearchContext& with_holdouts, const ModelStage& held) {
  if (is_explained(with_holdouts, held) || with_holdouts.cancelled()) return false;
  const SearchContext context = without_holdouts(with_holdouts);
  const InnovationStage stage =
      settled(context, held, {}, Settling::once, wide(context.options.threads));
  if (!std::isfinite(stage.minus_two_log)) return false;
  const double curve_nats = largest_curve_nats(stage);
  return curve_nats > kMuchMotion_nats && motion_explains_more(stage) &&
         curve_nats > line_nats(context, stage);
}

std::vector<Law> laws_of(const SearchContext& context, const ModelStage& held) {
  std::vector<Law> laws =
      law_dictionary(context.problem.model, context.problem.data, LawChoice::unexplained);
  if (!rubs(context, held.added))
    std::erase_if(laws, [](const Law& law) { return law.effect.site == "dry_friction"; });
  return laws;
}

/// The branch that begins with a candidate of the round, which may be without its Jacobian.
SearchBranch begun_with(const SearchContext& context, const Candidate& candidate,
                        const Round& round) {
  ModelStage stage = with(round.before, candidate);
  if (stage.fitted.jacobian.size() == 0) stage.fitted = refit_to_convergence(context, stage.fitted);
  return {std::move(stage), {round}, false};
}

/// What is sought in the place of effects: a law by itself where these explain the record already.
enum class LawsSought { alone, beside_others };

/// A law, or a law beside an effect or another law, that explains the record.
std::optional<SearchBranch> explaining(const SearchContext& context, const SearchStart& start,
                                       const std::vector<Law>& laws, LawsSought sought) {
  const std::vector<std::string> effects = names_of(context.problem.candidate_effects);
  const SearchContext alone = with_laws(context, laws, {});
  const SearchContext any = with_laws(context, laws, effects);
  SearchBranch single{start.first, {}, false};
  add_effects(alone, single, 1);
  if (single.rounds.empty() || context.cancelled()) return {};
  if (is_explained(alone, single.stage)) return single;
  if (sought == LawsSought::alone || !leaves_much_motion(alone, single.stage)) return {};
  const auto completes = [&](const SearchContext& beside, SearchBranch& branch) {
    add_effects(beside, branch, 2);
    if (branch.stage.added.size() != 2) return false;
    if (!is_explained(beside, branch.stage)) refit_without_refinements(beside, branch.stage);
    return is_explained(beside, branch.stage);
  };
  if (!start.branch.rounds.empty()) {
    const Round& named = start.branch.rounds.front();
    const double most_m = kNearBest * named.candidates.front().validation_rms_m;
    for (std::size_t i = 0; i < std::min(kNamed, named.candidates.size()); ++i) {
      const Candidate& effect = named.candidates[i];
      if (!effect.fitted_at_all || effect.validation_rms_m > most_m || context.cancelled()) break;
      SearchBranch beside_effect = begun_with(any, effect, named);
      if (completes(any, beside_effect)) return beside_effect;
    }
  }
  const Round& round = single.rounds.front();
  for (std::size_t i = 0; i < std::min(kBeginnings, round.candidates.size()); ++i) {
    if (!round.candidates[i].fitted_at_all || context.cancelled()) break;
    SearchBranch beside_law = begun_with(any, round.candidates[i], round);
    if (completes(any, beside_law)) return beside_law;
  }
  return {};
}

/// The laws of the branch and those that came nearest to them.
std::vector<Law> with_rivals(const std::vector<Law>& laws, const SearchBranch& branch) {
  std::vector<std::string> names = branch.stage.added;
  for (const Round& round : branch.rounds) {
    for (std::size_t i = 0; i < std::min(kRivalLaws, round.candidates.size()); ++i)
      names.push_back(round.candidates[i].effects.front());
  }
  std::vector<Law> result;
  for (const Law& law : laws) {
    if (std::find(names.begin(), names.end(), law.effect.name) != names.end())
      result.push_back(law);
  }
  return result;
}

}  // namespace

bool explain_by_laws(const SearchContext& context, const SearchStart& start, Diagnosis& result) {
  const ModelStage& first = start.first;
  const ModelStage& held = start.branch.stage;
  // parameters may differ between records before a law is missing
  if (context.problem.effects_only || context.problem.data.fitted_records != 1) return false;
  const bool bent = is_explained(context, held) && makes_up(held, first.fitted.parameters.size());
  if (!bent && !leaves_much_motion(context, held)) return false;
  const std::vector<Law> laws = laws_of(context, held);
  std::optional<SearchBranch> branch =
      explaining(context, start, laws, bent ? LawsSought::alone : LawsSought::beside_others);
  if (!branch || context.cancelled()) return false;
  LawSearch found{
      with_laws(context, with_rivals(laws, *branch), branch->stage.added), first, {}, {}};
  const SearchBranch taken{branch->stage, {}, false};
  found.innovations =
      search_innovations(found.context, first, taken, {branch->stage.added.size(), {}});
  const InnovationStage& final = found.innovations.final;
  found.laws = laws_among(laws, final.model.added);
  if (found.laws.empty() || found.laws.size() > kMostLaws || !found.explains_record()) return false;
  Diagnosis before = result;
  before.rms_after_m = held.fitted.validation_rms_m;
  before.whole = places_of(context, first);
  const InnovationStage bare = with_candidates(found.innovations.before, context);
  return is_clearly_likelier(context, final, bare, held) &&
         take_laws(context, first, found, before, result);
}

}  // namespace estimator::greybox::selection
