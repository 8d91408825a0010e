#include "estimator/greybox/selection/learned_laws.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "estimator/greybox/selection/change_search.h"
#include "estimator/greybox/selection/command_lead.h"
#include "estimator/greybox/selection/conclusion.h"
#include "estimator/greybox/selection/confidence.h"
#include "estimator/greybox/selection/law_search.h"
#include "estimator/greybox/selection/learned_curve.h"
#include "estimator/greybox/selection/parameter_subset.h"

namespace estimator::greybox::selection {
namespace {

/// Size of a law over its standard error, from which on it is learned.
constexpr double kClearOfError = 3.0;

/// Effects beside which much physics is missing, from which on laws of any kind are tried early.
constexpr std::size_t kBeforeLaws = 2;
/// Share of the error of named effects that a curve in their place may leave in a slow log: its
/// many knots follow what the command does between the samples, too.
constexpr double kCurveForNames = 0.8;
/// Share of the error that is left, below which laws that do not explain the record are of use.
constexpr double kApproximates = 0.5;
/// Promise of a curve over what effects gain, from which on it is sought in their place: a linear
/// estimate promises a third of what the law gains.
constexpr double kCurveForEffects = 0.25;
/// Most laws and effects together that an early search tries.
constexpr std::size_t kMostEarly = 3;

/// How a law enters, in the words of a Localisation.
std::string class_of(const Law& law) {
  if (law.effect.site == "force" || law.effect.site == "dry_friction") return "force";
  if (law.effect.site == "sensor") return "measurement";
  return law.effect.site == "leakage" || law.effect.site == "flow" ? "flow" : "gain";
}

/// Gives a diagnosis that ends at laws these, and a better model with them.
void take_as_they_are(const SearchContext& context, const std::vector<Law>& laws,
                      Diagnosis& learned) {
  learned.laws = laws;
  plant_sim::ModelFile model = context.problem.model;
  for (const Law& law : laws) model.declare(law.effect, "dictionary of laws");
  learned.better = with_values(model, learned.final);
}

/// Names the places of laws that explain a record.
void locate_laws(const LawSearch& found, const Diagnosis& before, Diagnosis& learned) {
  std::vector<Localisation> where;
  const double explained = 1.0 - std::pow(learned.rms_after_m / learned.rms_before_m, 2);
  for (const Law& law : found.laws)
    where.push_back({class_of(law), law.variables.front(), explained});
  for (const Localisation& other : before.whole) {
    const bool known = std::any_of(where.begin(), where.end(), [&](const Localisation& one) {
      return one.site == other.site && one.variable == other.variable;
    });
    if (!known) where.push_back(other);
  }
  learned.where = std::move(where);
  learned.where_is_whole = true;
}

/// The site of the laws that may stand where an effect does: what a valve lets through changes with
/// its opening, its overlap and its supply alike.
std::string site_of_laws(const std::string& site) {
  return site == "flow" || site == "supply" || site == "lap" || site == "edge" ? "opening" : site;
}

/// The main site of all of the effects; empty: they have several.
std::string shared_site(const std::vector<std::string>& effects) {
  std::string site;
  for (const std::string& name : effects) {
    const plant_sim::EffectInfo* effect = plant_sim::find_effect(name);
    if (effect == nullptr || effect->sites.empty()) return "";
    if (!site.empty() && effect->sites.front() != site) return "";
    site = effect->sites.front();
  }
  return site;
}

/// Takes the laws of a search where they leave less than `result`, by most_error_ratio().
bool take_better(const SearchContext& context, const ModelStage& first,
                 const std::optional<LawSearch>& found, Diagnosis& result) {
  Diagnosis learned;
  const bool slow_log = !floor_shows_lead(context.problem.data);
  if (!found || !take_laws(context, first, *found, result, learned)) return false;
  if (!(learned.rms_after_m < most_error_ratio(learned, result, slow_log) * result.rms_after_m))
    return false;
  result = std::move(learned);
  return true;
}

/// Seeks laws beside the effects and takes them as take_better does, where `accepts` allows it;
/// where it does not take several, fewer. Sets those that leave physics unexplained,
/// `approximate`.
template <class Accepts>
bool seek_laws(const SearchContext& context, const ModelStage& first,
               const std::vector<std::string>& effects, LawChoice choice, std::size_t most_effects,
               const Accepts& accepts, std::optional<LawSearch>& approximate, Diagnosis& result) {
  while (most_effects > 0) {
    const std::optional<LawSearch> found =
        search_laws(context, first, "", effects, choice, most_effects);
    if (!found) return false;
    if (!found->explains_record()) {
      approximate = found;
      return false;
    }
    if (!accepts(found->innovations.final)) return false;
    if (take_better(context, first, found, result)) return true;
    if (found->laws.size() < 2) return false;
    most_effects = found->innovations.final.model.added.size() - 1;
  }
  return false;
}

}  // namespace

bool take_laws(const SearchContext& context, const ModelStage& first, const LawSearch& found,
               const Diagnosis& before, Diagnosis& result) {
  Diagnosis learned = begun(before);
  conclude(found.context, found.context, first, found.innovations, learned);
  const auto is_size = [&](const ParameterValue& p) {
    return std::any_of(found.laws.begin(), found.laws.end(), [&](const Law& law) {
      return !law.effect.curve &&
             p.name == law.effect.name + "." + law.effect.parameters.front().name;
    });
  };
  for (const ParameterValue& p : learned.parameters) {
    if (!is_size(p)) continue;
    if (p.at_bound || !(std::abs(p.value) > kClearOfError * p.std_error)) return false;
  }
  if (learned.verdict == Verdict::unexplained) return false;
  learned.verdict = Verdict::learned;
  take_as_they_are(context, found.laws, learned);
  locate_laws(found, before, learned);
  result = std::move(learned);
  return true;
}

double most_error_ratio(const Diagnosis& learned, const Diagnosis& before, bool slow_log) {
  const bool formulas = std::none_of(learned.laws.begin(), learned.laws.end(),
                                     [](const Law& law) { return law.effect.curve.has_value(); });
  const bool at_floor =
      learned.disturbance && learned.disturbed_floor_m() > (1.0 - kRivals) * learned.rms_after_m;
  if (formulas) return at_floor ? 1.0 + kRivals : 1.0 - kRivals;
  const bool replaces =
      std::any_of(before.missing.begin(), before.missing.end(), [&](const std::string& effect) {
        return std::find(learned.missing.begin(), learned.missing.end(), effect) ==
               learned.missing.end();
      });
  const bool explains = learned.rms_after_m <= kUnexplained * learned.noise_floor_m;
  return slow_log && replaces && !explains ? kCurveForNames : 1.0 - kRivals;
}

bool learn_laws(const SearchContext& context, const ModelStage& first, const ModelStage& likeliest,
                std::optional<LawSearch>& approximate, Diagnosis& result) {
  const ModelStage named = result.search.final;
  const bool same = std::is_permutation(named.added.begin(), named.added.end(),
                                        likeliest.added.begin(), likeliest.added.end());
  std::vector<std::string> effects = named.added;
  for (const std::string& name : likeliest.added) {
    if (std::find(effects.begin(), effects.end(), name) == effects.end()) effects.push_back(name);
  }
  if (seek_laws(
          context, first, effects, LawChoice::unexplained, kMostInnovationEffects,
          [](const InnovationStage&) { return true; }, approximate, result)) {
    return true;
  }
  // a curve is more than a formula has to say: it comes last
  if (take_better(context, first, search_curve(context, first), result)) return true;
  const auto beside = [&](const ModelStage& base) {
    return !base.added.empty() && base.added.size() < kStandIn &&
           take_better(context, first, search_curve(context, base), result);
  };
  return beside(named) || (!same && beside(likeliest));
}

void approximate_by_laws(const SearchContext& context, const ModelStage& first,
                         const LawSearch& found, Diagnosis& result) {
  const FitSummary run = simulated(found.context, found.innovations.final.model.fitted);
  const double enough_m = kApproximates * result.rms_after_m;
  if (context.cancelled() || !(run.validation_rms_m < enough_m)) return;
  Diagnosis approximated = begun(result);
  conclude(found.context, found.context, first, found.innovations, approximated);
  if (!(approximated.rms_after_m < enough_m)) return;
  const std::vector<Law> laws = laws_among(found.laws, approximated.missing);
  if (laws.empty()) return;
  approximated.verdict = Verdict::unexplained;
  take_as_they_are(context, laws, approximated);
  result = std::move(approximated);
}

bool may_learn_early(const SearchContext& context, const InnovationStage& stage,
                     double inexact_nats) {
  // parameters may differ between records, and change within one, before a law is missing
  if (context.problem.data.fitted_records != 1) return false;
  const double level_nats = friction_level_nats(context, stage);
  if (level_nats > kCurve_nats + inexact_nats && level_nats > promised_nats(stage) &&
      level_nats > change_nats(stage)) {
    return true;
  }
  return stage.model.added.size() >= kBeforeLaws && leaves_much_physics(stage, inexact_nats) &&
         motion_explains_more(stage);
}

bool learn_law_early(const SearchContext& context, const ModelStage& first,
                     const InnovationStage& stage, const ModelStage& held, Diagnosis& result) {
  Diagnosis named = result;
  const auto is_likelier = [&](const InnovationStage& found) {
    if (!is_clearly_likelier(context, found, stage, held)) return false;
    named.rms_after_m = simulated(context, stage.model.fitted).validation_rms_m;
    named.whole = places_of(context, first);
    return true;
  };
  std::optional<LawSearch> approximate;
  if (!seek_laws(context, first, stage.model.added, LawChoice::beside_effects, kMostEarly,
                 is_likelier, approximate, named)) {
    return false;
  }
  result = std::move(named);
  return true;
}

bool prefer_law(const SearchContext& context, const ModelStage& first,
                const InnovationSearch& innovations, Diagnosis& result) {
  if (context.problem.effects_only) return false;
  const InnovationStage& named = innovations.final;
  const std::vector<std::string>& added = named.model.added;
  // several effects may stand in for one law, at any site
  const bool several = added.size() > 1;
  const std::string site = several ? "" : site_of_laws(shared_site(added));
  if (!several && (site.empty() || innovations.physics_missing())) return false;
  // a search is worth it only where one law competes with the effect
  if (!several && !law_competes(context, site, innovations)) return false;
  if (several && !innovations.physics_missing() && !law_promises(context, site, innovations)) {
    return false;
  }
  // one effect is compared with laws alone: which of them it would be is what is asked
  const std::optional<LawSearch> found =
      search_laws(context, first, site, several ? added : std::vector<std::string>(),
                  LawChoice::against_effects, std::min(added.size() + 1, kMostInnovationEffects));
  return found && found->explains_record() &&
         found->innovations.final.model.added.size() <= added.size() &&
         penalised(found->innovations.final) < penalised(named) - 2.0 * kRivals_nats &&
         take_laws(context, first, *found, result, result);
}

bool prefer_curve(const SearchContext& context, const ModelStage& first,
                  const InnovationSearch& innovations, Diagnosis& result) {
  const InnovationStage& named = innovations.final;
  const std::vector<std::string>& added = named.model.added;
  const bool resonates = std::find(added.begin(), added.end(), "second_mass") != added.end();
  if (context.problem.effects_only || context.cancelled() || !(resonates || added.size() > 1))
    return false;
  const double gained_nats = 0.5 * (penalised(innovations.before) - penalised(named));
  if (!(largest_curve_nats(innovations.before) > kCurveForEffects * gained_nats)) return false;
  const std::optional<LawSearch> found = search_curve(context, first);
  return found && penalised(found->innovations.final) < penalised(named) - 2.0 * kRivals_nats &&
         take_laws(context, first, *found, result, result);
}

}  // namespace estimator::greybox::selection
