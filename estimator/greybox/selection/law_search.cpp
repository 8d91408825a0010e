#include "estimator/greybox/selection/law_search.h"

#include <algorithm>
#include <utility>

namespace estimator::greybox::selection {
namespace {

/// The sizes of laws and of the effects beside them are scaled to the rig: half as many, each
/// within the range over which the linear estimate may move it, cover what is plausible.
constexpr Eigen::Index kLawSizes = kTrialSizes / 2;

std::vector<Law> laws_at(const SearchContext& context, const std::string& site, LawChoice choice) {
  std::vector<Law> dictionary = law_dictionary(context.problem.model, context.problem.data, choice);
  if (!site.empty())
    std::erase_if(dictionary, [&](const Law& law) { return law.effect.site != site; });
  return dictionary;
}

/// False where no law is better by kRivals_nats in the place of what was found: beside it a law is
/// never less likely than alone, and none promises half as much there. The parameters of a single
/// effect are counted; several with names are kept where a law is no likelier than they, inexact
/// as their models are.
bool promises(const SearchContext& search, const InnovationSearch& named) {
  const InnovationStage stage = with_candidates(named.final, search);
  const std::size_t with_effect = stage.model.fitted.parameters.size();
  const std::size_t own = with_effect - named.before.model.fitted.parameters.size();
  const bool alone = stage.model.added.size() == 1;
  const std::vector<ScreeningResult> screened = screened_effects(stage);
  return std::any_of(screened.begin(), screened.end(), [&](const ScreeningResult& law) {
    if (law.starts.empty()) return false;
    const std::size_t count = law.starts.front().parameters.size() - with_effect;
    const double saved_nats =
        own > count ? kPerParameter_nats * static_cast<double>(own - count) : 0.0;
    const double least_nats = 0.5 * kRivals_nats + (alone ? -saved_nats : named.inexact_nats);
    return expected_nats(stage, law) > least_nats;
  });
}

}  // namespace

SearchContext with_laws(const SearchContext& context, const std::vector<Law>& laws,
                        const std::vector<std::string>& effects) {
  SearchContext result = context;
  DiagnosisProblem& problem = result.problem;
  problem.trial_sizes = kLawSizes;
  for (const Law& law : laws) problem.model.declare(law.effect, "dictionary of laws");
  // the library's effects with the sizes that are typical of this rig
  const auto competes = [&](const std::string& name) {
    return std::find(effects.begin(), effects.end(), name) != effects.end();
  };
  std::erase_if(problem.candidate_effects, [&](const plant_sim::EffectInfo& effect) {
    // a spring with its rest far away may be a constant force
    const bool constant = effect.name == "load_force" && competes("load_spring");
    return !constant && !competes(effect.name);
  });
  for (const plant_sim::EffectInfo& effect : absent_effects(problem.model)) {
    const bool law = std::any_of(laws.begin(), laws.end(),
                                 [&](const Law& one) { return one.effect.name == effect.name; });
    if (law) problem.candidate_effects.push_back(effect);
  }
  return result;
}

InnovationStage with_candidates(InnovationStage stage, const SearchContext& search) {
  stage.context.problem.model = search.problem.model;
  stage.context.problem.candidate_effects = search.problem.candidate_effects;
  stage.context.problem.trial_sizes = search.problem.trial_sizes;
  return stage;
}

std::vector<Law> laws_among(const std::vector<Law>& laws, const std::vector<std::string>& effects) {
  std::vector<Law> among;
  for (const std::string& name : effects) {
    const auto law = std::find_if(laws.begin(), laws.end(),
                                  [&](const Law& one) { return one.effect.name == name; });
    if (law != laws.end()) among.push_back(*law);
  }
  return among;
}

bool rubs(const SearchContext& context, const std::vector<std::string>& effects) {
  plant_sim::ModelFile model = context.problem.model;
  const auto has = [&](const char* name) {
    const double* const level_N = model.value(name);
    return level_N != nullptr && *level_N > 0.0;
  };
  return has("friction.coulomb_N") || has("friction.static_N") ||
         std::find(effects.begin(), effects.end(), "friction") != effects.end();
}

double friction_level_nats(const SearchContext& context, const InnovationStage& stage) {
  if (!rubs(context, stage.model.added)) return 0.0;
  const std::vector<Law> levels = laws_at(context, "dry_friction", LawChoice::beside_effects);
  if (levels.empty() || context.cancelled()) return 0.0;
  return promised_nats(with_candidates(stage, with_laws(context, levels, {})));
}

double law_nats(const SearchContext& context, const InnovationStage& stage) {
  const std::vector<Law> laws = laws_at(context, "", LawChoice::against_effects);
  if (laws.empty() || context.cancelled()) return 0.0;
  return promised_nats(with_candidates(stage, with_laws(context, laws, {})));
}

bool law_promises(const SearchContext& context, const std::string& site,
                  const InnovationSearch& named) {
  const std::vector<Law> dictionary = laws_at(context, site, LawChoice::against_effects);
  if (dictionary.empty() || context.cancelled()) return false;
  return promises(with_laws(context, dictionary, {}), named);
}

bool law_competes(const SearchContext& context, const std::string& site,
                  const InnovationSearch& named) {
  const std::vector<Law> dictionary = laws_at(context, site, LawChoice::against_effects);
  if (dictionary.empty() || context.cancelled()) return false;
  const SearchContext search = with_laws(context, dictionary, {});
  if (!promises(search, named)) return false;
  TrialMemo memo;
  const std::vector<InnovationStage> others = exchanges_of(search, named, 0, memo);
  return std::any_of(others.begin(), others.end(), [&](const InnovationStage& other) {
    return penalised(other) < penalised(named.final) + 2.0 * kRivals_nats;
  });
}

std::optional<LawSearch> search_laws(const SearchContext& context, const ModelStage& first,
                                     const std::string& site,
                                     const std::vector<std::string>& effects, LawChoice choice,
                                     std::size_t most_effects) {
  std::vector<Law> dictionary = laws_at(context, site, choice);
  if (!rubs(context, effects))
    std::erase_if(dictionary, [](const Law& law) { return law.effect.site == "dry_friction"; });
  if (dictionary.empty() || context.cancelled()) return {};
  LawSearch search{with_laws(context, dictionary, effects), first, {}, {}};
  const auto ends_at = [&](const InnovationStage& stage, double inexact_nats) {
    return laws_among(dictionary, stage.model.added).size() >= kMostLaws &&
           leaves_much_physics(stage, inexact_nats);
  };
  search.innovations = search_innovations(search.context, first, {}, {most_effects, ends_at});
  const InnovationSearch& found = search.innovations;
  search.laws = laws_among(dictionary, found.final.model.added);
  if (search.laws.empty() || search.laws.size() > kMostLaws) return {};
  return search;
}

}  // namespace estimator::greybox::selection
