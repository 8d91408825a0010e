#include "estimator/greybox/selection/search_chance.h"

#include <algorithm>
#include <vector>

namespace estimator::greybox::selection {

Chance chance_of(const StructureSearch& search, const std::string& effect) {
  const auto has = [&](const std::vector<std::string>& effects) {
    return std::find(effects.begin(), effects.end(), effect) != effects.end();
  };
  for (auto round = search.rounds.rbegin(); round != search.rounds.rend(); ++round) {
    if (has(round->before.added)) continue;
    const auto own =
        std::find_if(round->candidates.begin(), round->candidates.end(),
                     [&](const auto& one) { return one.fitted_at_all && has(one.effects); });
    // 1: too few blocks of held-out data to say
    if (own == round->candidates.end()) continue;
    if (!(own->p_value < 1.0)) return {};
    return {own->p_value, own->p_value * static_cast<double>(round->candidates.size())};
  }
  return {};
}

}  // namespace estimator::greybox::selection
