#include "estimator/greybox/selection/beside_curve.h"

#include <algorithm>
#include <string>
#include <utility>

namespace estimator::greybox::selection {
namespace {

/// The dictionary's laws, without those over the curve's variable at its site: they are no more
/// than a part of it.
std::vector<Law> laws_beside(const SearchContext& context, const LawSearch& learned) {
  const Law& curve = learned.laws.front();
  std::vector<Law> laws = law_dictionary(context.problem.model, context.problem.data);
  const bool friction = rubs(context, learned.innovations.final.model.added);
  std::erase_if(laws, [&](const Law& law) {
    return (law.variables == curve.variables && law.effect.site == curve.effect.site) ||
           (!friction && law.effect.site == "dry_friction");
  });
  return laws;
}

/// The context with the laws and all of its effects as candidates.
SearchContext with_all(const SearchContext& context, const std::vector<Law>& laws) {
  std::vector<std::string> effects;
  for (const plant_sim::EffectInfo& effect : context.problem.candidate_effects)
    effects.push_back(effect.name);
  return with_laws(context, laws, effects);
}

SearchContext beside_curve(const SearchContext& context, const LawSearch& learned,
                           const std::vector<Law>& laws) {
  SearchContext with_curve = learned.context;
  with_curve.problem.candidate_effects = context.problem.candidate_effects;
  return with_all(with_curve, laws);
}

}  // namespace

double promised_beside_nats(const SearchContext& context, const LawSearch& learned) {
  const SearchContext search = beside_curve(context, learned, laws_beside(context, learned));
  return promised_nats(with_candidates(learned.innovations.final, search));
}

std::optional<BesideCurve> seek_beside_curve(const SearchContext& context,
                                             const LawSearch& learned) {
  const std::vector<Law> laws = laws_beside(context, learned);
  const SearchContext search = beside_curve(context, learned, laws);
  const ModelStage& alone = learned.innovations.final.model;
  BesideCurve beside{with_all(context, laws), {}, {}, {}};
  beside.innovations = search_innovations(search, alone, {}, {kMostInnovationEffects, {}});
  const InnovationStage& final = beside.innovations.final;
  const std::vector<std::string>& added = final.model.added;
  const std::string& curve = learned.laws.front().effect.name;
  beside.laws = laws_among(laws, added);
  if (context.cancelled() || added.size() == alone.added.size() ||
      std::find(added.begin(), added.end(), curve) == added.end() ||
      beside.laws.size() >= kMostLaws) {
    return {};
  }
  beside.without_curve = without(without_holdouts(search), final, curve);
  return beside;
}

}  // namespace estimator::greybox::selection
